//! What an effort means, and when a search by chance has looked long enough.
//!
//! Seeds are drawn in rounds, and every round's walks may find a better valley. Two signs say that the best one is known:
//!
//! * The *room* between the bounds is small: whatever is still unknown gains little.
//! * Walks *come back*: when several, from seeds far from each other, end at one and the same best pose, a better valley would have to be one
//!   that all of them missed (the stopping rules of multistart search: Boender and Rinnooy Kan 1987). Of queries whose best pose was met three times
//!   hardly one had a better answer; of those that met it once, many. DISP's bound is close as a rule, and where it is not, the bodies
//!   lock into each other: more walks have to come back then.
//!
//! DISP's least motion is a translation more often than not, and its bound often proves that nothing is much better. So its first round begins with
//! translations alone, and may end there.
//!
//! So quick queries stay quick, and time goes where the answer is in doubt.

use super::seeds::rays;
use crate::mesh::Model;
use crate::mesh::certificate::Effort;
use crate::mesh::metric::Certificate;

/// What a query of an effort does, for a pair of models and a kind of metric.
pub struct Schedule {
    pub rays: rays::Fan,
    /// Translations come first, and are all there is when one walk from them brings the ratio of the bounds down to this. `None`: all
    /// rays at once.
    pub translations_suffice: Option<f64>,
    /// Translations near the best pose's that are tried in the end, at a time.
    pub beside: usize,
    /// Rounds of rays and walks at most.
    pub rounds: usize,
    /// When fewer are enough.
    pub patience: Patience,
    /// Pairs of triangles that pushing out may look at in one query.
    pub work: usize,
    /// The least gain of an iteration of the walks.
    pub coarse: f64,
    /// That of the walk from the best pose in the end.
    pub gain: f64,
    /// A walk is given up when it will not come below this multiple of the best.
    pub hope: f64,
}

/// When a further round is worth its time.
#[derive(Clone, Copy)]
pub struct Patience {
    /// Up to this ratio of the bounds, none is.
    near: f64,
    /// Beyond, so many per unit of the ratio.
    slope: f64,
    /// As long as fewer walks than this have ended at the best pose.
    returns: usize,
    /// The same where there is a lower bound and the bounds' ratio is beyond [`WIDE`].
    returns_if_wide: usize,
}

/// Where bounds are farther from each other than this, more walks have to come back.
const WIDE: f64 = 1.06;

impl Patience {
    /// Whether so many walks that have ended at the best pose are enough.
    pub fn is_satisfied(&self, lower: f64, upper: f64, returns: usize) -> bool {
        returns >= if lower > 0.0 && upper > WIDE * lower { self.returns_if_wide } else { self.returns }
    }

    /// Whether another round is wanted after so many, when so many walks have ended at the best pose.
    pub fn goes_on(&self, rounds: usize, lower: f64, upper: f64, returns: usize) -> bool {
        !self.is_satisfied(lower, upper, returns) && upper - self.near * lower > lower * (rounds as f64 / self.slope)
    }
}

/// Meshes whose numbers of triangles have a smaller product than this are quick, and searched more.
const QUICK: f64 = 1e5;
/// By this factor at most.
const MOST_MORE: f64 = 6.0;

impl Schedule {
    pub fn new(effort: Effort, a: &Model, b: &Model, kind: Certificate) -> Schedule {
        let pairs = a.mesh().triangles().len() as f64 * b.mesh().triangles().len() as f64;
        let more = (QUICK / pairs).sqrt().sqrt().clamp(1.0, MOST_MORE);
        let times = |count: usize| (count as f64 * more) as usize;
        let rays = |translations, screws, worse, seeds| rays::Fan {
            translations,
            screws: times(screws),
            worse,
            seeds: times(seeds),
        };
        // DISP's lower bound is close to it. The object norm's walks are smooth and end slowly.
        let disp = kind == Certificate::Disp;
        let patience = match kind {
            Certificate::Disp => Patience { near: 1.03, slope: 60.0, returns: 3, returns_if_wide: 11 },
            Certificate::SqrtSigma | Certificate::None => {
                Patience { near: 1.15, slope: 50.0, returns: 3, returns_if_wide: 3 }
            }
        };
        let translations_suffice = disp.then_some(1.02);
        let beside = if disp { 16 } else { 0 };
        match effort {
            Effort::Fast => Schedule {
                rays: rays(20, 12, 1.1, 2),
                translations_suffice,
                beside: 0,
                rounds: 1,
                patience,
                work: 4_000,
                coarse: 3e-2,
                gain: 1e-3,
                hope: 0.97,
            },
            Effort::Default => Schedule {
                rays: rays(32, 64, if disp { 1.2 } else { 1.3 }, 5),
                translations_suffice,
                beside,
                rounds: 20,
                patience,
                work: 8_000,
                coarse: if disp { 3e-2 } else { 1e-2 },
                gain: 1e-4,
                hope: if disp { 0.95 } else { 1.0 },
            },
            Effort::Heavy => Schedule {
                rays: rays(64, 128, 1.4, 10),
                translations_suffice: None,
                beside: 4 * beside,
                rounds: 20,
                patience: Patience { near: 1.001, slope: f64::INFINITY, returns: 30, returns_if_wide: 30 },
                work: 200_000,
                coarse: 1e-3,
                gain: 1e-5,
                hope: 1.05,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Patience;

    const PATIENCE: Patience = Patience { near: 1.1, slope: 10.0, returns: 3, returns_if_wide: 5 };

    #[test]
    fn narrow_brackets_are_left_alone() {
        assert!(!PATIENCE.goes_on(0, 1.0, 1.1, 0));
        assert!(PATIENCE.goes_on(0, 1.0, 1.11, 0));
    }

    #[test]
    fn rounds_are_proportional_to_the_room() {
        let rounds = |upper| (0..100).take_while(|&k| PATIENCE.goes_on(k, 1.0, upper, 0)).count();
        assert_eq!(rounds(1.45), 4);
        assert_eq!(rounds(1.85), 8);
    }

    #[test]
    fn walks_that_come_back_end_the_search() {
        assert!(PATIENCE.goes_on(1, 1.0, 9.0, 4));
        assert!(!PATIENCE.goes_on(1, 1.0, 9.0, 5));
        let patience = Patience { near: 1.01, ..PATIENCE };
        assert!(patience.goes_on(0, 1.0, 1.05, 2));
        assert!(!patience.goes_on(0, 1.0, 1.05, 3));
        assert!(!patience.goes_on(0, 0.0, 9.0, 3));
    }

    #[test]
    fn without_a_bound_there_is_room() {
        assert!(PATIENCE.goes_on(1_000_000, 0.0, 1e-300, 0));
        assert!(PATIENCE.goes_on(0, 0.0, f64::INFINITY, 0));
        assert!(Patience { slope: f64::INFINITY, ..PATIENCE }.goes_on(99, 1.0, 1.2, 0));
    }
}
