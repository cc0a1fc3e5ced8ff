//! A small generator of random numbers (PCG): the tests depend on no crate and on no clock.

#[derive(Clone, Debug)]
pub struct Dice {
    state: u64,
}

impl Dice {
    pub fn new(seed: u64) -> Self {
        let mut dice = Dice { state: seed ^ 0x9e37_79b9_7f4a_7c15 };
        dice.bits();
        dice.bits();
        dice
    }

    /// 32 random bits.
    pub fn bits(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = (((old >> 18) ^ old) >> 27) as u32;
        x.rotate_right((old >> 59) as u32)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        ((u64::from(self.bits()) << 21) ^ u64::from(self.bits())) as f64 / (1u64 << 53) as f64
    }

    /// In [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// In [-1, 1).
    pub fn signed(&mut self) -> f64 {
        self.range(-1.0, 1.0)
    }

    /// 10 to the power of a number in [low, high).
    pub fn decade(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.range(low, high))
    }

    /// 0 .. n - 1.
    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    /// True with this probability.
    pub fn chance(&mut self, p: f64) -> bool {
        self.unit() < p
    }

    /// One of these.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// Standard normal (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }

    /// A random unit vector.
    pub fn direction<const N: usize>(&mut self) -> [f64; N] {
        loop {
            let v: [f64; N] = std::array::from_fn(|_| self.normal());
            let l = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if l > 1e-3 {
                return v.map(|x| x / l);
            }
        }
    }

    /// A random orthonormal matrix, row by row (Gram-Schmidt twice: orthonormal to rounding); of determinant 1
    /// for N = 3.
    pub fn rotation<const N: usize>(&mut self) -> [[f64; N]; N] {
        let mut m = [[0.0; N]; N];
        for i in 0..N {
            let mut v = self.direction::<N>();
            for _ in 0..2 {
                for row in m.iter().take(i) {
                    let along: f64 = v.iter().zip(row).map(|(a, b)| a * b).sum();
                    v.iter_mut().zip(row).for_each(|(a, b)| *a -= along * b);
                }
                let l = v.iter().map(|x| x * x).sum::<f64>().sqrt();
                v = v.map(|x| x / l);
            }
            m[i] = v;
        }
        if N == 3 {
            let (a, b, c) = (&m[0], &m[1], &m[2]);
            let det = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            if det < 0.0 {
                m[2] = m[2].map(|x| -x);
            }
        }
        m
    }

    /// A rotation by a small angle about a random axis, times nothing: the matrix entries carry their rounding.
    pub fn tilt(&mut self, angle: f64) -> [[f64; 3]; 3] {
        let [x, y, z] = self.direction::<3>();
        let (s, c) = angle.sin_cos();
        let v = 1.0 - c;
        [
            [c + x * x * v, x * y * v - z * s, x * z * v + y * s],
            [y * x * v + z * s, c + y * y * v, y * z * v - x * s],
            [z * x * v - y * s, z * y * v + x * s, c + z * z * v],
        ]
    }
}
