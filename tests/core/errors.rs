//! Every public error is a `core::error::Error` whose message says what is wrong.

use std::collections::BTreeSet;
use std::error::Error;

use qdist::GraphError;
use qdist::WorkspaceError;
use qdist::nalgebra::Matrix3;
use qdist::support::{BoxShape, Cylinder, Failure, Points, ShapeError};
use qdist::{Body, BodyError, NOT_FINITE, Options, Vector, Workspace};

/// README's first example and a pose, in a function that a program would have.
fn depth(half: f64, turn: f64) -> Result<f64, Box<dyn Error>> {
    let cube = BoxShape::new(Vector::from([half, 0.5, 0.5]))?;
    let post = Cylinder::new(0.1, 1.0)?;
    let mut memory = Workspace::<f64, 3, 64, 128>::new();
    let a = Body::at(&cube, Vector::zeros());
    let b = Body::new(&post, Matrix3::identity() * turn, Vector::from([0.55, 0.0, 0.0]))?;
    let depth = memory.solver().depth(&a, &b, &Options::default());
    assert!(depth.lower <= 0.05 && 0.05 <= depth.upper);
    Ok(depth.upper)
}

#[test]
fn the_example_of_the_readme_in_a_function_of_any_error() {
    assert!(depth(0.5, 1.0).is_ok());
    let message = |half, turn| depth(half, turn).unwrap_err().to_string();
    let says = "a size of the shape (a radius, half extent, semi axis, half height, margin or scale) is negative";
    assert_eq!(message(-0.5, 1.0), says);
    assert_eq!(message(f64::NAN, 1.0), "a number of the shape is NaN, infinite or too large");
    assert_eq!(message(0.5, 1.1), "the matrix of the body's pose is not a rotation to within 1e-4");
    assert_eq!(message(0.5, f64::NAN), "a coordinate of the body's pose is NaN or infinite");
}

#[test]
fn a_hull_that_cannot_be_prepared_says_why() {
    let mut memory = Workspace::<f64, 3, 64, 128>::new();
    let mut prepare = |points: &[[f64; 3]], words: usize| -> Box<dyn Error> {
        memory.solver().prepare_hull(points, &mut vec![0; words], None).err().unwrap().into()
    };
    assert_eq!(prepare(&[], 100).to_string(), "the shape has no points, or the unit set none but the origin");
    let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    assert!(Points::new(&flat).is_ok());
    assert_eq!(prepare(&flat, 100).to_string(), "the points of the hull lie in one plane");
}

#[test]
fn every_message_is_its_own() {
    let mut errors: Vec<Box<dyn Error>> = vec![
        Box::new(ShapeError::Negative),
        Box::new(ShapeError::NonFinite),
        Box::new(ShapeError::Empty),
        Box::new(ShapeError::NotOrthonormal),
        Box::new(BodyError::NonFinite),
        Box::new(BodyError::Rotation),
        Box::new(GraphError::Flat),
        Box::new(GraphError::Capacity),
        Box::new(GraphError::Words),
        Box::new(WorkspaceError::Capacity),
        Box::new(WorkspaceError::Size),
        Box::new(WorkspaceError::Alignment),
        Box::new(Failure(NOT_FINITE)),
        Box::new(Failure(7)),
    ];
    #[cfg(feature = "grasp")]
    errors.extend([
        Box::new(qdist::grasp::ContactError::Normal) as Box<dyn Error>,
        Box::new(qdist::grasp::GraspError { contact: 3, error: qdist::grasp::ContactError::Normal }),
        Box::new(qdist::grasp::ForceError::Wrench),
    ]);
    let messages: BTreeSet<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(messages.len(), errors.len());
    assert!(messages.iter().all(|m| m.len() > 10));
    assert!(Failure(7).to_string().ends_with("code 7"));
}
