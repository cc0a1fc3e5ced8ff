//! TRACKER
//!
//! The depth of a body that moves a little from tick to tick, in a loop of 1 kHz: free poses are remembered, and a tick makes the best of
//! them better, within a budget. It never waits, and knows no clock but yours: `late` of the budget is asked before every query, and no query
//! begins once it says so. What has begun is finished: some microseconds, at most a certificate (0.1 to 1 ms).
//!
//!   qdist_mesh_tracker_create(tool, part, &tracker);
//!   qdist_mesh_budget_default(&budget);
//!   budget.late = my_clock_says_late, budget.late_user = &my_clock;
//!   depth.struct_size = sizeof depth;
//!   for (;;) {
//!       if (... another thread's qdist_mesh_pair_depth has a new answer ...) qdist_mesh_tracker_merge(tracker, &answer, NULL);
//!       qdist_mesh_tracker_update(tracker, &pose, &budget, &depth);
//!       ... a spring from `pose` to `depth.pose` ...
//!   }
//!
//! It follows one valley of the free space. Cold answers from another thread, with a pair of its own, show it better ones. Contacts at depth.pose are
//! qdist_mesh_pair_contacts of another pair of the same meshes.

use super::*;
use qdist::mesh::{Budget, Counters, DepthTracker};

/// A tracker: opaque.
pub struct qdist_mesh_tracker(Exclusive<Between<DepthTracker<'static>>>);

/// Asked before every query of a tick; anything but 0 ends the tick with QDIST_MESH_INTERRUPTED and the bracket so far. Look at a clock, or, to
/// cancel, at a flag that another thread sets (atomically).
///
/// user: late_user of the budget.
pub type qdist_mesh_late = Option<unsafe extern "C" fn(user: *mut c_void) -> i32>;

/// What a tick may cost, and by which metric it measures. Begin with qdist_mesh_budget_default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_mesh_budget {
    pub struct_size: u32,
    /// QDIST_MESH_DISP (default), QDIST_MESH_SIGMA or QDIST_MESH_OWN. It may change from tick to tick.
    pub metric: qdist_mesh_metric,
    /// Collision, contact and distance queries, default 16; the pose itself is always tested. Where no free pose is known, up to 6 more.
    pub max_queries: u64,
    /// The tick ends when upper - lower <= relative * upper; 0 or more, default 1e-3.
    pub relative: f64,
    /// Tests at random poses that are nearer than the best, by which the tracker leaves its valley; default 4.
    pub probes: u32,
    /// 1 (default): lower bounds are renewed when there is none or a tenth of the depth has been lost. 0: they are not, and are 0 in the end.
    pub certify: u32,
    /// With how much effort; default QDIST_MESH_FAST.
    pub effort: qdist_mesh_effort,
    /// QDIST_MESH_SIGMA: as `mass` of qdist_mesh_options. NULL (default): A's own.
    pub mass: In<qdist_mesh_mass>,
    /// QDIST_MESH_OWN: your metric. Else NULL (default), or not looked at.
    pub own: In<qdist_mesh_own_metric>,
    /// NULL (default): there is no clock.
    pub late: qdist_mesh_late,
    /// For `late`.
    pub late_user: *mut c_void,
}
gaps!(qdist_mesh_budget, effort..mass, late_user..);
versioned!(qdist_mesh_budget);

impl Defaults for qdist_mesh_budget {
    fn defaults() -> Self {
        let usual = Budget::default();
        qdist_mesh_budget {
            struct_size: size_of::<qdist_mesh_budget>() as u32,
            metric: QDIST_MESH_DISP,
            max_queries: usual.max_queries,
            relative: usual.relative,
            probes: usual.probes,
            certify: usual.certificate.is_some() as u32,
            effort: QDIST_MESH_FAST,
            ..Self::ZERO
        }
    }
}

/// Writes the defaults, struct_size included.
///
/// Status: none but those of all functions.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_budget_default(budget: Out<qdist_mesh_budget>) -> qdist_status {
    status(budget.put(qdist_mesh_budget::defaults()))
}

/// The caller's budget, checked.
struct Tick {
    metric: Chosen,
    budget: Budget,
    late: qdist_mesh_late,
    user: *mut c_void,
}

impl Tick {
    fn new(budget: In<qdist_mesh_budget>) -> Check<Tick> {
        let budget = budget.or_default()?;
        let metric = Chosen::new(budget.metric, budget.mass, budget.own)?;
        let (relative, effort) = (not_negative(budget.relative)?, effort(budget.effort)?);
        let limits = Budget {
            max_queries: budget.max_queries,
            relative,
            probes: budget.probes,
            certificate: flag(budget.certify)?.then_some(effort),
        };
        Ok(Tick { metric, budget: limits, late: budget.late, user: budget.late_user })
    }
}

/// Makes a tracker of two meshes, which may be the same: A moves, B rests. Allocates. The meshes may be freed before it.
///
/// Status: none but those of all functions.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_tracker_create(
    a: In<qdist_mesh>,
    b: In<qdist_mesh>,
    tracker: Out<*mut qdist_mesh_tracker>,
) -> qdist_status {
    guard(|| {
        tracker.checked()?;
        tracker.put(Box::into_raw(Box::new(qdist_mesh_tracker(Between::of(a, b, DepthTracker::new)?))))
    })
}

/// Frees a tracker; NULL is nothing, and so is the tracker that is calling the caller.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_tracker_free(tracker: Out<qdist_mesh_tracker>) {
    if tracker.get().is_ok_and(|tracker| tracker.0.take().is_ok()) {
        // SAFETY: the header: from qdist_mesh_tracker_create, once.
        drop(unsafe { tracker.boxed() });
    }
}

/// A tick: the depth of A at a pose. budget: NULL for the defaults. The bracket is true however little was allowed; `distance` of a separated pose is
/// filled if the budget had a query left for it (distance_queries is 1), else 0. Outcomes and errors are those of qdist_mesh_pair_depth; after an
/// error the tracker is as before.
/// Allocates for certificates, when the memory of its queries must grow, and where very many features touch.
///
/// Status: those of a pose (pose) and of a metric; ARGUMENT (budget->effort; certify is neither 0 nor 1; relative is negative), NONFINITE
/// (budget->relative).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_tracker_update(
    tracker: Out<qdist_mesh_tracker>,
    pose: In<qdist_mesh_pose>,
    budget: In<qdist_mesh_budget>,
    depth: Out<qdist_mesh_depth>,
) -> qdist_status {
    guard(|| {
        depth.known()?;
        let (mut tracker, pose, tick) = (tracker.get()?.0.take()?, pose.get()?.checked()?, Tick::new(budget)?);
        let model = tracker.a.clone();
        let metric = tick.metric.of(&model)?;
        let found = tracker.ask(|tracker| {
            // SAFETY: the header: `late` may be called with `late_user` during the call.
            let late = || tick.late.is_some_and(|late| unsafe { late(tick.user) } != 0);
            let clock = tick.late.is_some().then_some(&late as &dyn Fn() -> bool);
            tracker.update(&pose, metric, &tick.budget, clock)
        })?;
        depth.put_version(qdist_mesh_depth::new(&found))
    })
}

/// Takes over the pose of an answer from elsewhere, whatever pose it was the answer for: qdist_mesh_pair_depth of another thread, say. Only
/// struct_size and `pose` are read. The pose counts from the next tick, if it is better there, or far from what is known. One collision query.
///
/// taken: 1 if the pose is free, else 0, and nothing has changed. May be NULL.
///
/// Status: those of a pose (answer->pose).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_tracker_merge(
    tracker: Out<qdist_mesh_tracker>,
    answer: In<qdist_mesh_depth>,
    taken: Out<u32>,
) -> qdist_status {
    guard(|| {
        taken.optional()?;
        let pose = answer.current()?.pose.checked();
        let (mut tracker, pose) = (tracker.get()?.0.take()?, pose?);
        // The tracker tests the pose, and believes nothing else.
        let answer = MeshDepth {
            outcome: Outcome::Bounded,
            lower: 0.0,
            upper: f64::MAX,
            pose,
            distance: None,
            solid: false,
            counters: Counters::default(),
            walks: 0,
        };
        let free = tracker.ask(|tracker| tracker.merge(&answer))?;
        if taken.is_null() { Ok(()) } else { taken.put(free.into()) }
    })
}

/// Forgets everything: the next tick is the first.
///
/// Status: none but those of all functions.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_tracker_reset(tracker: Out<qdist_mesh_tracker>) -> qdist_status {
    guard(|| {
        let mut tracker = tracker.get()?.0.take()?;
        tracker.ask(DepthTracker::reset)
    })
}
