//! Random vectors and matrices for the tests of this module.

use nalgebra::SMatrix;

use crate::math::Vector;

/// A 3 x 3 matrix.
pub type M = SMatrix<f64, 3, 3>;

pub struct Dice(pub u64);

impl Dice {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64) / ((1u64 << 53) as f64) * 2.0 - 1.0
    }
    pub fn vector(&mut self) -> Vector<f64, 3> {
        Vector::from([0; 3].map(|_| self.next()))
    }
    /// A rotation whose entries are off by up to `off`.
    pub fn rotation(&mut self, off: f64) -> M {
        let a = self.vector().normalize();
        let b = a.cross(&self.vector()).normalize();
        M::from_columns(&[a, b, a.cross(&b)]) + M::from_fn(|_, _| off * self.next())
    }
    /// Mostly generic, sometimes almost along a column: where the signs of a box are decided by rounding.
    pub fn direction(&mut self, r: &M) -> Vector<f64, 3> {
        let noise = self.vector();
        if self.next() > 0.0 { noise } else { r.column(0) + noise * 1e-8 * self.next() }
    }
}

pub fn down(v: &Vector<f64, 3>) -> Vector<f32, 3> {
    v.map(|x| x as f32)
}

pub fn up(v: &Vector<f32, 3>) -> Vector<f64, 3> {
    v.map(f64::from)
}

pub fn single(m: &M) -> SMatrix<f32, 3, 3> {
    m.map(|x| x as f32)
}
