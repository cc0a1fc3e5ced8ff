//! What a weakest direction means, in words.
//!
//! Wrenches of W are those that the contacts exert on the object, G f (eq. 2). If d q, q in Q, is on the surface of W, then the *external* wrench
//! -d q is the largest of its kind that the grasp resists: it is hardest to resist.

use qdist::Vector;
use qdist::grasp::{Norm, WrenchSet};
use qdist::support::Support;

use crate::grasp::sets::Part;

/// Within 10 degrees of an axis, or of a plane of two.
const ALONG: f64 = 0.985;
/// A part that is less than this of the whole is not worth a word.
const SMALL: f64 = 0.1;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The axis that a vector is along, and whether against it.
fn axis(v: &Vector<f64, 3>) -> Option<(&'static str, bool)> {
    let (i, x) = (v.iamax(), v.amax());
    (x >= ALONG * v.norm()).then(|| (AXES[i], v[i] < 0.0))
}

fn sign(negative: bool) -> &'static str {
    if negative { "-" } else { "+" }
}

/// Where a vector points: "+x", "between +x and -y" in the middle, "(0.27, -0.53, 0.80)".
fn heading(v: &Vector<f64, 3>) -> String {
    if let Some((name, negative)) = axis(v) {
        return format!("{}{name}", sign(negative));
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| v[j].abs().total_cmp(&v[i].abs()));
    let [a, b, _] = order;
    let part = |i: usize| format!("{}{}", sign(v[i] < 0.0), AXES[i]);
    let even = v[b].abs() >= 0.8 * v[a].abs() && v[a].hypot(v[b]) >= ALONG * v.norm();
    if even {
        return format!("between {} and {}", part(a), part(b));
    }
    // Without the sign of what is rounded to 0.
    let v = v.normalize().map(|x| (x * 100.0).round() / 100.0 + 0.0);
    format!("({:.2}, {:.2}, {:.2})", v.x, v.y, v.z)
}

fn push(force: &Vector<f64, 3>) -> String {
    let way = heading(force);
    if way.starts_with("between") { format!("a push {way}") } else { format!("a push along {way}") }
}

fn turn(moment: &Vector<f64, 3>) -> String {
    match axis(moment) {
        // A moment along +z turns counterclockwise for who looks down on the plane from +z.
        Some((name, negative)) => {
            let sense = if negative { "clockwise" } else { "counterclockwise" };
            format!("a turn about {name}, {sense} seen from +{name}")
        }
        None => {
            let way = heading(moment);
            let about = if way.starts_with("between") {
                "a right-handed turn about a line"
            } else {
                "a right-handed turn about"
            };
            format!("{about} {way}")
        }
    }
}

/// A wrench as forces and moments, the larger part first.
pub fn wrench(w: &Vector<f64, 6>) -> String {
    let (force, moment) = (w.fixed_rows::<3>(0).into_owned(), w.fixed_rows::<3>(3).into_owned());
    let (f, m, all) = (force.norm(), moment.norm(), w.norm());
    // Of a grasp without any wrench no direction is the weakest.
    if !(all > 0.0) {
        return "any wrench".into();
    }
    if m < SMALL * all {
        return push(&force);
    }
    if f < SMALL * all {
        return turn(&moment);
    }
    let (push, turn) = (push(&force), turn(&moment));
    if m < 0.5 * f {
        format!("mostly {push}, with {turn}")
    } else if f < 0.5 * m {
        format!("mostly {turn}, with {push}")
    } else if f >= m {
        format!("{push} together with {turn}")
    } else {
        format!("{turn} together with {push}")
    }
}

/// What is hardest to resist: the reaction to the weakest wrench of Q that the contacts exert.
pub fn hardest(weakest: &Vector<f64, 6>) -> String {
    wrench(&-weakest)
}

/// The contacts whose force caps limit d, with their share h_i(u) / h(u) of it at the weakest direction u: the relative growth of d per relative
/// growth of the cap, where u is unique. Under L1 the strongest contact alone has h(u). Contacts as strong as the strongest, to `tolerance`, are
/// named with it: under L1, d grows only with all of them together.
pub fn worst(names: &[String], set: &WrenchSet<f64, Part>, u: &Vector<f64, 6>, tolerance: f64) -> String {
    let heights: Vec<f64> = set.contributions().iter().map(|part| part.value(u)).collect();
    let most = heights.iter().copied().fold(0.0, f64::max);
    if !(most > 4.0 * set.error() * u.norm()) {
        return "no contact resists it".into();
    }
    let as_strong = names.iter().zip(&heights).filter(|(_, h)| **h >= most * (1.0 - tolerance));
    let named: Vec<&str> = as_strong.map(|(name, _)| name.as_str()).collect();
    let contacts =
        if let [one] = named.as_slice() { format!("contact {one}") } else { format!("contacts {}", named.join(", ")) };
    match set.norm() {
        Norm::L1 if named.len() > 1 => format!("limited by {contacts} together"),
        Norm::L1 => format!("limited by {contacts}"),
        Norm::LInf => {
            let each = if named.len() > 1 { " each" } else { "" };
            format!("limited by {contacts} ({:.0} %{each})", 100.0 * most / heights.iter().sum::<f64>())
        }
    }
}

#[cfg(test)]
mod tests {
    use qdist::grasp::Primitive;
    use qdist::nalgebra::SMatrix;

    use super::*;

    #[test]
    fn wrenches_in_words() {
        for (w, words) in [
            ([0.0, -3.0, 0.1, 0.0, 0.0, 0.0], "a push along -y"),
            ([1.0, 0.9, 0.0, 0.0, 0.0, 0.0], "a push between +x and +y"),
            ([0.6, -0.4, 0.0, 0.0, 0.0, 0.0], "a push along (0.83, -0.55, 0.00)"),
            ([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], "a push along (0.58, 0.58, 0.58)"),
            ([0.0, 0.0, 0.0, 0.0, 0.0, 2.0], "a turn about z, counterclockwise seen from +z"),
            ([0.0, 0.0, 0.0, -2.0, 0.0, 0.0], "a turn about x, clockwise seen from +x"),
            ([0.0, 0.0, 0.0, 1.0, 0.0, 1.0], "a right-handed turn about a line between +x and +z"),
            ([0.0, 0.0, 0.0, -1.0, 1.0, 1.0], "a right-handed turn about (-0.58, 0.58, 0.58)"),
            (
                [2.0, 0.0, 0.0, 0.0, 0.5, 0.0],
                "mostly a push along +x, with a turn about y, counterclockwise seen from +y",
            ),
            ([0.5, 0.0, 0.0, 0.0, -2.0, 0.0], "mostly a turn about y, clockwise seen from +y, with a push along +x"),
            (
                [1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
                "a push along +x together with a turn about z, counterclockwise seen from +z",
            ),
            ([0.0; 6], "any wrench"),
        ] {
            assert_eq!(wrench(&Vector::from(w)), words);
        }
    }

    /// Of three contacts that push along x, the strongest, and two that are as strong.
    #[test]
    fn the_contacts_that_limit() {
        let x = Vector::<f64, 6>::x();
        let names = ["a", "b", "c"].map(String::from);
        let tell = |forces: [f64; 3], norm| {
            let primitives = forces.map(|f| Part::Contact(Box::new(Primitive::new(x * f, SMatrix::zeros()).unwrap())));
            worst(&names, &WrenchSet::new(&primitives, norm), &x, 1e-3)
        };
        assert_eq!(tell([1.0, 2.0, -1.0], Norm::L1), "limited by contact b");
        assert_eq!(tell([1.0, 3.0, -1.0], Norm::LInf), "limited by contact b (75 %)");
        assert_eq!(tell([2.0, 2.0, 1.0], Norm::L1), "limited by contacts a, b together");
        assert_eq!(tell([2.0, 2.0, 1.0], Norm::LInf), "limited by contacts a, b (40 % each)");
        assert_eq!(tell([-1.0, -1.0, 0.0], Norm::LInf), "no contact resists it");
    }

    /// What the contacts exert upwards at most resists what pulls down.
    #[test]
    fn the_hardest_is_the_reaction() {
        assert_eq!(hardest(&Vector::from([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])), "a push along -z");
    }
}
