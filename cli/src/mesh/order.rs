//! What is farther comes first. Facets are cut where they pass through each other's planes, so that there is such an order, and edges stay straight
//! (binary space partition: Fuchs, Kedem & Naylor, 1980).

use qdist::nalgebra::{Point3, Vector3};

/// A convex piece of a triangle, as it is drawn.
#[derive(Clone, Debug)]
pub struct Facet {
    pub corners: Vec<Point3<f64>>,
    /// Of length 1, towards the one who looks.
    pub normal: Vector3<f64>,
    pub color: [u8; 3],
    pub of_a: bool,
}

/// So many facets are put in order at once. More are cut into tiles as they are seen, since planes of many would cut too much.
const FEW: usize = 48;
const LEVELS: usize = 14;
/// Of so many planes the one that cuts least.
const TRIED: usize = 8;

/// `axes`: the picture's, across the line of sight. What is nearer than `small` to a plane lies in it; there the order stays.
pub fn back_to_front(facets: Vec<Facet>, axes: [Vector3<f64>; 2], small: f64) -> Vec<Facet> {
    let mut ordered = Vec::new();
    let mut open = vec![(facets, 0)];
    while let Some((facets, level)) = open.pop() {
        if facets.len() <= FEW || level == LEVELS {
            partition(facets, small, &mut ordered);
            continue;
        }
        let normal = axes[level % 2];
        let mut middles: Vec<f64> = facets.iter().map(|facet| normal.dot(&facet.corners[0].coords)).collect();
        let half = middles.len() / 2;
        let (_, &mut offset, _) = middles.select_nth_unstable_by(half, f64::total_cmp);
        let mut sides = Sides::default();
        for facet in facets {
            Plane { normal, offset }.part(facet, small, &mut sides);
        }
        sides.behind.append(&mut sides.within);
        open.extend([(sides.behind, level + 1), (sides.front, level + 1)]);
    }
    ordered
}

fn partition(facets: Vec<Facet>, small: f64, ordered: &mut Vec<Facet>) {
    let step = (facets.len() / TRIED).max(1);
    let planes = facets.iter().step_by(step).map(Plane::of);
    let Some(plane) = planes.min_by_key(|plane| facets.iter().filter(|facet| plane.cuts(facet, small)).count()) else {
        return;
    };
    let mut sides = Sides::default();
    for facet in facets {
        plane.part(facet, small, &mut sides);
    }
    if sides.within.is_empty() {
        // (Only numbers out of all proportion.)
        ordered.extend(sides.behind.into_iter().chain(sides.front));
        return;
    }
    partition(sides.behind, small, ordered);
    ordered.append(&mut sides.within);
    partition(sides.front, small, ordered);
}

#[derive(Default)]
struct Sides {
    behind: Vec<Facet>,
    within: Vec<Facet>,
    front: Vec<Facet>,
}

struct Plane {
    normal: Vector3<f64>,
    offset: f64,
}

impl Plane {
    fn of(facet: &Facet) -> Plane {
        Plane { normal: facet.normal, offset: facet.normal.dot(&facet.corners[0].coords) }
    }

    fn heights(&self, facet: &Facet) -> Vec<f64> {
        facet.corners.iter().map(|p| self.normal.dot(&p.coords) - self.offset).collect()
    }

    fn cuts(&self, facet: &Facet, small: f64) -> bool {
        let heights = self.heights(facet);
        heights.iter().any(|&h| h > small) && heights.iter().any(|&h| h < -small)
    }

    fn part(&self, facet: Facet, small: f64, sides: &mut Sides) {
        let heights = self.heights(&facet);
        match (heights.iter().any(|&h| h < -small), heights.iter().any(|&h| h > small)) {
            (false, false) => sides.within.push(facet),
            (true, false) => sides.behind.push(facet),
            (false, true) => sides.front.push(facet),
            (true, true) => {
                let (mut behind, mut front) = (Vec::new(), Vec::new());
                // (What lies in the plane is an end of both pieces: an edge of no length would have any direction.)
                let heights: Vec<f64> = heights.iter().map(|&h| if h.abs() <= small { 0.0 } else { h }).collect();
                for (i, (p, &h)) in facet.corners.iter().zip(&heights).enumerate() {
                    let next = (i + 1) % heights.len();
                    if h <= 0.0 {
                        behind.push(*p);
                    }
                    if h >= 0.0 {
                        front.push(*p);
                    }
                    if h * heights[next] < 0.0 {
                        let between = p + (facet.corners[next] - p) * (h / (h - heights[next]));
                        behind.push(between);
                        front.push(between);
                    }
                }
                sides.behind.push(Facet { corners: behind, ..facet.clone() });
                sides.front.push(Facet { corners: front, ..facet });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(height: f64, tilt: f64, of_a: bool) -> Facet {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = corners.map(|(x, y)| Point3::new(x, y, height + tilt * x)).to_vec();
        Facet { corners, normal: Vector3::new(-tilt, 0.0, 1.0).normalize(), color: [0; 3], of_a }
    }

    fn ordered(facets: Vec<Facet>) -> Vec<Facet> {
        back_to_front(facets, [Vector3::x(), Vector3::y()], 1e-9)
    }

    #[test]
    fn what_is_farther_comes_first() {
        let facets = ordered((0..200).map(|k| square(f64::from(k * 7 % 200), 0.0, false)).collect());
        for (x, y) in [(-0.7, 0.3), (0.1, -0.6), (0.9, 0.9)] {
            let around = |side: f64, at: f64, of: fn(&Point3<f64>) -> f64, facet: &Facet| {
                facet.corners.iter().any(|p| side * (of(p) - at) >= 0.0)
            };
            let here = facets.iter().filter(|facet| {
                [-1.0, 1.0].into_iter().all(|side| around(side, x, |p| p.x, facet) && around(side, y, |p| p.y, facet))
            });
            let heights: Vec<f64> = here.map(|facet| facet.corners[0].z).collect();
            assert!(heights.len() == 200 && heights.is_sorted());
        }
    }

    #[test]
    fn facets_that_pass_through_each_other_are_cut_there() {
        let facets = ordered(vec![square(0.0, 0.0, false), square(0.0, 1.0, true)]);
        assert_eq!(facets.len(), 3);
        assert!(facets.iter().flat_map(|facet| &facet.corners).all(|p| p.x.abs() > 0.99 || p.x.abs() < 1e-9));
        assert!(facets[0].corners.iter().all(|p| p.z <= 1e-9));
    }

    #[test]
    fn in_one_plane_the_order_stays() {
        let facets = ordered(vec![square(0.0, 0.0, false), square(0.0, 0.0, true)]);
        assert_eq!(facets.iter().map(|facet| facet.of_a).collect::<Vec<_>>(), [false, true]);
    }
}
