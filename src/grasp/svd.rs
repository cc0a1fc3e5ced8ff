//! Singular values of small matrices, by Jacobi's one-sided method.
//!
//! nalgebra's SVD is not used: it panics on failure and may loop forever. This one ends after a fixed number of sweeps,
//! keeps zero columns and columns that are orthogonal already as they are, bit by bit, and finds small singular values
//! to high relative accuracy.

use crate::math::dot;
use crate::scalar::Real;

/// Sweeps until orthogonality is to rounding: convergence is quadratic, 4 to 8 are usual.
const SWEEPS: usize = 30;

/// `A V` with orthogonal columns, the orthogonal V, and the norms of the columns: the singular values, in descending order.
/// Matrices are arrays of columns.
pub(super) struct Svd<T, const R: usize, const C: usize> {
    pub image: [[T; R]; C],
    pub v: [[T; C]; C],
    pub sigma: [T; C],
}

impl<T: Real, const R: usize, const C: usize> Svd<T, R, C> {
    /// Of the matrix with columns `a`, finite numbers whose squares do not overflow.
    pub fn new(a: [[T; R]; C]) -> Self {
        let identity = core::array::from_fn(|i| core::array::from_fn(|j| if i == j { T::one() } else { T::zero() }));
        let mut svd = Self { image: a, v: identity, sigma: [T::zero(); C] };
        for _ in 0..SWEEPS {
            let mut turned = false;
            for p in 0..C {
                for q in p + 1..C {
                    turned |= svd.turn(p, q);
                }
            }
            if !turned {
                break;
            }
        }
        svd.sigma = svd.image.map(|x| dot(&x, &x).root());
        for i in 0..C {
            for j in i + 1..C {
                if svd.sigma[j] > svd.sigma[i] {
                    svd.sigma.swap(i, j);
                    svd.image.swap(i, j);
                    svd.v.swap(i, j);
                }
            }
        }
        svd
    }

    /// The number of singular values above `threshold`.
    pub fn rank(&self, threshold: T) -> usize {
        self.sigma.iter().filter(|&&s| s > threshold).count()
    }

    /// Rotates columns p and q so that they are orthogonal; false if they are, to rounding.
    fn turn(&mut self, p: usize, q: usize) -> bool {
        let (x, y) = (self.image[p], self.image[q]);
        let (xx, yy, xy) = (dot(&x, &x), dot(&y, &y), dot(&x, &y));
        if !(xy.abs() > T::count(R) * T::ROUNDOFF * (xx.root() * yy.root())) {
            return false;
        }
        let zeta = (yy - xx) / (xy + xy);
        let t = (zeta.abs() + (T::one() + zeta * zeta).root()).recip().copysign(zeta);
        let c = (T::one() + t * t).root().recip();
        let s = c * t;
        (self.image[p], self.image[q]) = rotated(&x, &y, c, s);
        (self.v[p], self.v[q]) = rotated(&self.v[p], &self.v[q], c, s);
        true
    }
}

fn rotated<T: Real, const K: usize>(x: &[T; K], y: &[T; K], c: T, s: T) -> ([T; K], [T; K]) {
    (core::array::from_fn(|i| c * x[i] - s * y[i]), core::array::from_fn(|i| s * x[i] + c * y[i]))
}

/// The triangular factor of a matrix that arrives row by row: the same singular values and the same V, in N x N numbers.
/// Givens rotations; rows should be of size 1 or less.
pub(super) struct Triangular<T, const N: usize> {
    rows: [[T; N]; N],
}

impl<T: Real, const N: usize> Triangular<T, N> {
    pub fn new() -> Self {
        Self { rows: [[T::zero(); N]; N] }
    }

    pub fn add(&mut self, mut row: [T; N]) {
        for (k, own) in self.rows.iter_mut().enumerate() {
            let (a, b) = own.iter().zip(&row).nth(k).map_or((T::zero(), T::zero()), |(&a, &b)| (a, b));
            let r = (a * a + b * b).root();
            if r > T::zero() {
                (row, *own) = rotated(&row, own, a / r, b / r);
            }
        }
    }

    /// The singular value decomposition of all rows that were added.
    pub fn svd(&self) -> Svd<T, N, N> {
        Svd::new(core::array::from_fn(|j| core::array::from_fn(|i| self.rows[i][j])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Dice(u64);
    impl Dice {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// A V = image, V orthogonal, the image's columns orthogonal, sorted.
    fn check<const R: usize, const C: usize>(a: [[f64; R]; C]) -> Svd<f64, R, C> {
        let svd = Svd::new(a);
        let size = a.iter().map(|x| dot(x, x)).sum::<f64>().sqrt();
        for i in 0..C {
            for r in 0..R {
                let mapped: f64 = (0..C).map(|k| a[k][r] * svd.v[i][k]).sum();
                assert!((mapped - svd.image[i][r]).abs() <= 1e-14 * size);
            }
            for j in 0..C {
                let unit = if i == j { 1.0 } else { 0.0 };
                assert!((dot(&svd.v[i], &svd.v[j]) - unit).abs() < 1e-14);
                let product = dot(&svd.image[i], &svd.image[j]);
                assert!(i == j || product.abs() <= 1e-14 * svd.sigma[i] * svd.sigma[j]);
            }
            assert!(i == 0 || svd.sigma[i - 1] >= svd.sigma[i]);
        }
        svd
    }

    #[test]
    fn random_and_deficient_matrices() {
        let mut dice = Dice(5);
        for round in 0..2000 {
            let mut a: [[f64; 8]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| dice.next()));
            match round % 4 {
                1 => a[3] = core::array::from_fn(|i| a[0][i] - 2.0 * a[1][i]),
                2 => a = a.map(|x| x.map(|y| y * 10f64.powf(20.0 * dice.next()))),
                3 => a[2] = [0.0; 8],
                _ => {}
            }
            let svd = check(a);
            let rank = svd.rank(1e-13 * svd.sigma[0]);
            assert!(if round % 2 == 1 { rank == 3 } else { round % 4 == 2 || rank == 4 }, "{round} {:?}", svd.sigma);
        }
        check([[0.0; 6]; 6]);
        check([[f64::MIN_POSITIVE; 3]; 4]);
    }

    #[test]
    fn orthogonal_columns_stay_exact() {
        let svd = check([[0.0, 0.2, 0.0], [0.0, 0.0, 0.0], [0.1, 0.0, 0.0]]);
        assert_eq!(svd.v, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
        assert_eq!(svd.sigma, [0.2, 0.1, 0.0]);
    }

    #[test]
    fn rows_one_by_one_have_the_same_singular_values() {
        let mut dice = Dice(9);
        for _ in 0..200 {
            let columns: [[f64; 20]; 6] = core::array::from_fn(|_| core::array::from_fn(|_| dice.next()));
            let mut triangle = Triangular::new();
            for r in 0..20 {
                triangle.add(core::array::from_fn(|c| columns[c][r]));
            }
            let (small, large) = (triangle.svd(), check(columns));
            for i in 0..6 {
                assert!((small.sigma[i] - large.sigma[i]).abs() < 1e-13 * large.sigma[0]);
                assert!(dot(&small.v[i], &large.v[i]).abs() > 1.0 - 1e-9);
            }
        }
    }

    #[test]
    fn anything_ends() {
        for x in [f64::NAN, f64::INFINITY, 1e300, 5e-324] {
            Svd::new([[x, 1.0, 2.0], [1.0, x, -x], [0.0, x, 1.0]]);
        }
    }
}
