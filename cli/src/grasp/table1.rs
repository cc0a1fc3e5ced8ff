//! The paper's Table I, rows (a1) to (a5), beside ours.
//!
//! The paper gives no coordinates. Two soft contacts on the x axis at -0.75 and 1.3, with mu = mus = 0.2, planar fingers and L-infinity have all ten values
//! of rows (a1) to (a5), to the paper's tolerance of 1e-4; each has a closed form.

use std::io::Write;

use qdist::Vector;
use qdist::grasp::{Contact, ContactError, Friction, HandContact, Jacobian, Norm};

use crate::grasp::input::Set;
use crate::grasp::query::{self, Effort, Memory};
use crate::grasp::sets::Sets;
use crate::grasp::unit_sets::{Q, Shape};
use crate::{Trouble, written};

/// What the paper prints for one set: d, iterations, seconds.
struct Printed(f64, u32, f64);

/// A row of the paper: name, Q, W, W^a.
struct Row(&'static str, &'static str, Printed, Printed);

/// W^a is 3-D in all of them.
const ROWS: [Row; 5] = [
    Row("a1", "ball", Printed(0.2425, 437, 155.18), Printed(0.2425, 3, 0.0028)),
    Row("a2", "ellipsoid", Printed(0.2235, 359, 108.93), Printed(0.2236, 4, 0.0040)),
    Row("a3", "cross-polytope", Printed(0.3154, 96, 11.330), Printed(0.3155, 3, 0.0039)),
    Row("a4", "cube", Printed(0.1119, 82, 6.1654), Printed(0.1513, 4, 0.0032)),
    Row("a5", "segment along x", Printed(1.0, 18, 0.2989), Printed(1.0, 2, 0.0026)),
];

const NOTES: &str = "\
The paper's values come from an algorithm that stops within 1e-4, in MATLAB on a Core i7 of 2.67 GHz; K is its number of iterations. Ours are upper
bounds of brackets no wider than `gap`, K the points added. The pairs 0.2235 and 0.2236, 0.3154 and 0.3155 are equal in truth.
Rows (b1) to (h) cannot be reproduced: the paper gives neither the block's size nor the positions of contacts and hand, and no block fits all of these
rows.";

/// Two fingers whose joints move them in the x-y plane.
fn hand() -> Result<[HandContact<f64>; 2], ContactError> {
    let y = Vector::from([0.0, 1.0, 0.0]);
    let finger = |x: f64| {
        let n = Vector::from([-x.signum(), 0.0, 0.0]);
        let contact = Contact::new(Vector::from([x, 0.0, 0.0]), n, Friction::Soft { mu: 0.2, mus: 0.2 })?;
        let jacobian = Jacobian::new([&[1.0, 0.4, 0.2], &[0.3, 0.9, 0.5], &[0.0; 3], &[0.0; 3]])?;
        Ok(HandContact { contact: contact.with_tangents(y, n.cross(&y))?, jacobian: Some(jacobian) })
    };
    Ok([finger(-0.75)?, finger(1.3)?])
}

fn shapes() -> [Shape; 5] {
    let ones = vec![1.0; 6];
    let first = |x: f64, others: f64| vec![x, others, others, others, others, others];
    [
        Shape::Ball(1.0),
        Shape::Ellipsoid(first(2.0, 1.0)),
        Shape::CrossPolytope(ones.clone()),
        Shape::Box(ones),
        // From -1 to 1.
        Shape::Box(first(1.0, 0.0)),
    ]
}

/// The table.
pub fn print(out: &mut dyn Write, effort: &Effort) -> Result<(), Trouble> {
    let sets = Sets::new(&hand().map_err(|e| e.to_string())?)?;
    let mut memory = Box::new(Memory::new());
    let mut solver = memory.solver();
    let (head, ours) = ("paper: d      K        s", "ours: d     gap     K        ms");
    let mut lines = vec![
        format!("{:24}{:^58}   {:^64}", "Table I", "W", "W^a"),
        format!("{:24}{head} | {ours}   Dim | {head} | Dim {ours}", ""),
    ];
    for (Row(name, q, passive, active), shape) in ROWS.iter().zip(shapes()) {
        let unit = Q::new(shape, None)?;
        let mut line = format!("({name}) {q:<18}");
        for (set, Printed(d, k, time)) in [(Set::Passive, passive), (Set::Active, active)] {
            let found = query::solve(&mut solver, sets.get(set), set, Norm::LInf, &unit, effort)?;
            let (answer, dimension) = (&found.answer, found.dimension);
            let gap = (answer.upper - answer.lower).max(0.0);
            let (published, dim) = match set {
                Set::Passive => (String::new(), String::new()),
                Set::Active => ("  3 |".into(), format!("  {dimension}")),
            };
            let time_here = found.time.as_secs_f64() * 1e3;
            line += &format!("{published} {d:>12.4} {k:>6} {time:>8.4} |{dim}");
            line += &format!(" {:>7.4} {gap:>7.0e} {:>5} {time_here:>9.3}  ", answer.upper, answer.iterations);
        }
        lines.push(line.trim_end().into());
    }
    lines.push(NOTES.into());
    writeln!(out, "{}\n", lines.join("\n")).map_err(written)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed forms of all ten values, and the paper's to its tolerance.
    #[test]
    fn rows_to_four_digits() {
        let sets = Sets::new(&hand().unwrap()).unwrap();
        let mut memory = Box::new(Memory::new());
        let effort = Effort { relative: 1e-4, time: std::time::Duration::from_secs(600) };
        let root = |x: f64| x.sqrt();
        let corner = |n: f64| 0.41 / (0.41 + 2.3 * root(n));
        let exact = [
            [0.41 / root(0.1681 + 1.69 + 1.0), 0.41 / root(0.1681 + 1.69 + 1.0)],
            [0.41 / root(4.0 * 0.1681 + 1.69 + 1.0), 0.41 / root(4.0 * 0.1681 + 1.69 + 1.0)],
            [0.41 / 1.3, 0.41 / 1.3],
            [corner(2.0), corner(1.0)],
            [1.0, 1.0],
        ];
        for ((shape, Row(name, _, passive, active)), exact) in shapes().into_iter().zip(&ROWS).zip(exact) {
            let q = Q::new(shape, None).unwrap();
            for ((set, printed), d) in [(Set::Passive, passive), (Set::Active, active)].into_iter().zip(exact) {
                let found = query::solve(&mut memory.solver(), sets.get(set), set, Norm::LInf, &q, &effort).unwrap();
                let (lower, upper) = (found.answer.lower, found.answer.upper);
                assert!(lower <= d + 1e-13 && d - 1e-13 <= upper, "{name} {set:?}: {d} not in {lower} {upper}");
                assert!(upper - lower <= 1e-4 * upper && (upper - d).abs() < 1e-6, "{name} {set:?}");
                assert!((printed.0 - d).abs() < 1.5e-4, "{name} {set:?}");
                assert_eq!(found.dimension, if set == Set::Active { 3 } else { 6 });
            }
        }
    }
}
