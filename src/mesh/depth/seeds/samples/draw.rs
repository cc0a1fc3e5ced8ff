//! Drawing a sample: a random free pose, a random colliding one, and the contact between both.

use super::super::super::random::Random;
use crate::mesh::{Mesh, Pair, Screw};
use nalgebra::{Isometry3, Point3, Translation3};

/// A sample touches to this fraction of A's diagonal.
const TOUCH: f64 = 1e-6;
/// Random poses that are tried before one is made that surely is free, or collides.
const TRIES: usize = 64;

/// What draws samples.
pub struct Sampler<'m> {
    pair: Pair<'m>,
    random: Random,
    /// Centres of the bounding boxes.
    centres: [Point3<f64>; 2],
    /// At this distance of the centres the bounding balls touch.
    reach: f64,
}

impl<'m> Sampler<'m> {
    pub fn new(a: &'m Mesh, b: &'m Mesh, seed: u64) -> Sampler<'m> {
        let centres = [a, b].map(|mesh| {
            let (low, high) = mesh.bounds();
            nalgebra::center(&low, &high)
        });
        let reach = 0.5 * (a.diagonal() + b.diagonal());
        Sampler { pair: Pair::new(a, b), random: Random::new(seed), centres, reach }
    }

    /// The last free pose between a free one and a colliding one.
    pub fn sample(&mut self) -> Option<Isometry3<f64>> {
        let colliding = self.colliding();
        let free = self.free()?;
        let screw = Screw::new(&colliding, &free);
        let s = self.pair.bisect(&screw, 1.0, 0.0, TOUCH * self.pair.a().diagonal());
        Some(screw.at(s))
    }

    /// A pose with the centres at this distance, in units of the reach, into a random direction.
    fn at(&mut self, distance: f64) -> Isometry3<f64> {
        let rotation = self.random.rotation();
        let centre = self.centres[1] + self.random.direction() * (distance * self.reach);
        Isometry3::from_parts(Translation3::from(centre - rotation * self.centres[0]), rotation)
    }

    /// Uniform among the poses with overlapping balls.
    fn anywhere(&mut self) -> Isometry3<f64> {
        let share = self.random.signed().abs();
        self.at(share.cbrt())
    }

    fn colliding(&mut self) -> Isometry3<f64> {
        for _ in 0..TRIES {
            let pose = self.anywhere();
            if self.pair.collides(&pose) {
                return pose;
            }
        }
        // Thin bodies hardly ever meet by chance: a corner of A is put onto a corner of B.
        let (a, b) = (self.pair.a(), self.pair.b());
        let corner = |random: &mut Random, mesh: &Mesh| {
            let triangle = random.below(mesh.triangles().len());
            mesh.corners(triangle as u32)[random.below(3)]
        };
        let (p, q) = (corner(&mut self.random, a), corner(&mut self.random, b));
        let rotation = self.random.rotation();
        Isometry3::from_parts(Translation3::from(q - rotation * p), rotation)
    }

    fn free(&mut self) -> Option<Isometry3<f64>> {
        for _ in 0..TRIES {
            let pose = self.anywhere();
            if !self.pair.collides(&pose) {
                return Some(pose);
            }
        }
        // Balls that do not touch.
        (0..TRIES).find_map(|_| {
            let pose = self.at(1.0 + 1e-6);
            (!self.pair.collides(&pose)).then_some(pose)
        })
    }
}
