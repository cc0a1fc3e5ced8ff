//! The search's own random numbers (PCG), so that they are the same everywhere.

use nalgebra::{UnitQuaternion, Vector3};

#[derive(Clone, Debug)]
pub(super) struct Random {
    state: u64,
}

impl Random {
    pub fn new(seed: u64) -> Random {
        let mut random = Random { state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x853c_49e6_748f_ea9b };
        random.bits();
        random.bits();
        random
    }

    fn bits(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = (((old >> 18) ^ old) >> 27) as u32;
        x.rotate_right((old >> 59) as u32)
    }

    /// In [-1, 1).
    pub fn signed(&mut self) -> f64 {
        f64::from(self.bits()) / f64::from(1u32 << 31) - 1.0
    }

    /// A number below n, at least 1.
    pub fn below(&mut self, n: usize) -> usize {
        self.bits() as usize % n
    }

    /// A uniform direction.
    pub fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = Vector3::new(self.signed(), self.signed(), self.signed());
            let n = v.norm_squared();
            if (1e-4..=1.0).contains(&n) {
                return v / n.sqrt();
            }
        }
    }

    /// A uniform rotation.
    pub fn rotation(&mut self) -> UnitQuaternion<f64> {
        loop {
            let q = nalgebra::Quaternion::new(self.signed(), self.signed(), self.signed(), self.signed());
            if (1e-4..=1.0).contains(&q.norm_squared()) {
                return UnitQuaternion::from_quaternion(q);
            }
        }
    }
}
