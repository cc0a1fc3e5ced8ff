//! Random grasps of soft fingertips on the unit ball.

use qdist::Vector;
use qdist::grasp::{Contact, Friction, WrenchFrame};

use crate::common::dice::Dice;

/// About the middle, with moments as they are.
pub fn frame() -> WrenchFrame<f64> {
    WrenchFrame::new(Vector::zeros(), 1.0).expect("a frame")
}

/// A soft fingertip that presses roughly towards the middle of the unit ball.
pub fn fingertip(dice: &mut Dice) -> Contact<f64> {
    let p = Vector::<f64, 3>::from(dice.direction::<3>());
    let n = (Vector::<f64, 3>::from(dice.direction::<3>()) * 0.3 - p).normalize();
    let friction = Friction::Soft { mu: dice.range(0.3, 1.0), mus: dice.range(0.1, 0.4) };
    Contact::new(p, n, friction).expect("a contact")
}
