//! DEPTH
//!
//! How little must A move, rotations included, to be free of B? Local minima abound and no practical method finds the least of them with
//! certainty, so the answer is a bracket: no free pose is nearer than `lower`, and `pose` is free, proved by the solid test, at the
//! distance `upper`. Lower bounds above 0 need both meshes from qdist_mesh_certify.

use super::*;
use qdist::mesh::certificate::Effort;
use qdist::mesh::{DepthOptions, Progress};

/// How much is done for a depth?
pub type qdist_mesh_effort = u32;

/// A few seeds: an upper bound at once.
pub const QDIST_MESH_FAST: qdist_mesh_effort = 0;
/// What finds nearly all minima.
pub const QDIST_MESH_DEFAULT: qdist_mesh_effort = 1;
/// Several times as much, and a lower bound with care.
pub const QDIST_MESH_HEAVY: qdist_mesh_effort = 2;

/// How did a query end? Whatever it says, the bracket holds.
pub type qdist_mesh_outcome = i32;

/// The bracket is as narrow as asked for.
pub const QDIST_MESH_CONVERGED: qdist_mesh_outcome = 0;
/// All that the effort or the tick's budget provides for was done, and the bracket is wider than asked for. So end most queries of bodies that are not convex.
pub const QDIST_MESH_BOUNDED: qdist_mesh_outcome = 1;
/// The bodies do not overlap: both bounds are 0, and `distance` is filled.
pub const QDIST_MESH_SEPARATED: qdist_mesh_outcome = 2;
/// `watch` of the options said so.
pub const QDIST_MESH_INTERRUPTED: qdist_mesh_outcome = 3;
/// The number of queries is used up.
pub const QDIST_MESH_BUDGET: qdist_mesh_outcome = 4;
/// No free pose was found: `upper` is DBL_MAX, and `pose` is the query's.
pub const QDIST_MESH_STUCK: qdist_mesh_outcome = 5;
/// Sizes so extreme, or a metric of yours such, that the metric is no number: `lower` is 0, `upper` is DBL_MAX, and `pose` is the query's.
pub const QDIST_MESH_INVALID: qdist_mesh_outcome = 6;

/// The name of an outcome, e.g. "separated". A static string, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_outcome_string(outcome: qdist_mesh_outcome) -> *const c_char {
    outcome_name(outcome)
}

// (What is not known one day: the bracket would be true.)
outcomes! {
    outcome(Outcome) -> qdist_mesh_outcome, or QDIST_MESH_BOUNDED; outcome_name, or c"unknown outcome";
    Converged = QDIST_MESH_CONVERGED, c"converged";
    Bounded = QDIST_MESH_BOUNDED, c"bounded";
    Separated = QDIST_MESH_SEPARATED, c"separated";
    Interrupted = QDIST_MESH_INTERRUPTED, c"interrupted";
    Budget = QDIST_MESH_BUDGET, c"budget";
    Stuck = QDIST_MESH_STUCK, c"stuck";
    Invalid = QDIST_MESH_INVALID, c"invalid";
}

pub(super) fn effort(effort: qdist_mesh_effort) -> Check<Effort> {
    match effort {
        QDIST_MESH_FAST => Ok(Effort::Fast),
        QDIST_MESH_DEFAULT => Ok(Effort::Default),
        QDIST_MESH_HEAVY => Ok(Effort::Heavy),
        _ => Err(QDIST_ERROR_ARGUMENT),
    }
}

/// How far a query is.
#[repr(C)]
pub struct qdist_mesh_progress {
    /// The bracket so far; `upper` is DBL_MAX before the first free pose.
    pub lower: f64,
    pub upper: f64,
    /// The pose that proves `upper`, once there is one; before, the query's.
    pub pose: qdist_mesh_pose,
    /// Share of the search that is done, 0 to 1.
    pub fraction: f64,
    /// Collision, contact and distance queries so far.
    pub queries: u64,
}

/// Called several times a millisecond during a query; anything but 0 ends it with QDIST_MESH_INTERRUPTED and the bracket so far, after
/// some tens of queries at most that bring the best pose to contact. Draw a progress
/// bar, look at a clock, or at a flag that another thread sets (atomically).
///
/// user: watch_user of the options. progress: valid during the call.
pub type qdist_mesh_watch =
    Option<unsafe extern "C" fn(user: *mut c_void, progress: *const qdist_mesh_progress) -> i32>;

/// What a query does. Begin with qdist_mesh_options_default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_mesh_options {
    pub struct_size: u32,
    /// QDIST_MESH_DISP (default), QDIST_MESH_SIGMA or QDIST_MESH_OWN.
    pub metric: qdist_mesh_metric,
    /// QDIST_MESH_FAST, QDIST_MESH_DEFAULT (default) or QDIST_MESH_HEAVY.
    pub effort: qdist_mesh_effort,
    /// Number of `poses`; default 0.
    pub pose_count: u32,
    /// Number of the random sequence; default 0. The same query with the same seed gives the same answer, to the last digit.
    pub seed: u64,
    /// The query ends after this many collision, contact and distance queries, but for some tens to bring the best pose to contact; default
    /// UINT64_MAX. Queries take some microseconds each.
    pub max_queries: u64,
    /// The query ends when upper - lower <= relative * upper; 0 or more, default 1e-3.
    pub relative: f64,
    /// Poses to begin with, free or not: the last frame's answer, the answer for another metric, a guess. NULL if pose_count is 0.
    pub poses: In<qdist_mesh_pose>,
    /// QDIST_MESH_SIGMA: a distribution of mass to average over in place of A's own volume, in A's frame; A need not be a solid
    /// then. No lower bound is known for it: `lower` is 0. NULL (default): A's own. The volume only scales the inertia.
    pub mass: In<qdist_mesh_mass>,
    /// QDIST_MESH_OWN: your metric. Else NULL (default), or not looked at.
    pub own: In<qdist_mesh_own_metric>,
    /// NULL (default): nothing is called.
    pub watch: qdist_mesh_watch,
    /// For `watch`.
    pub watch_user: *mut c_void,
}
gaps!(qdist_mesh_options, watch_user..);
versioned!(qdist_mesh_options);

impl Defaults for qdist_mesh_options {
    fn defaults() -> Self {
        let usual = DepthOptions::default();
        qdist_mesh_options {
            struct_size: size_of::<qdist_mesh_options>() as u32,
            metric: QDIST_MESH_DISP,
            effort: QDIST_MESH_DEFAULT,
            seed: usual.seed,
            max_queries: usual.max_queries,
            relative: usual.relative,
            ..Self::ZERO
        }
    }
}

/// An answer: lower <= depth <= upper.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_mesh_depth {
    pub struct_size: u32,
    /// How the query ended, e.g. QDIST_MESH_CONVERGED.
    pub outcome: qdist_mesh_outcome,
    /// No free pose is nearer than this.
    pub lower: f64,
    /// The metric's distance between the query's pose and `pose`.
    pub upper: f64,
    /// A free pose, in the frame of B; the query's own when it is free, or with QDIST_MESH_STUCK and QDIST_MESH_INVALID.
    pub pose: qdist_mesh_pose,
    /// QDIST_MESH_SEPARATED: the distance of the surfaces. Else 0.
    pub distance: qdist_mesh_distance,
    /// 1 if an inside was seen, since A or B is a solid; 0 if the depth is that of surfaces.
    pub solid: u32,
    /// Walks along the boundary of the free space that were made.
    pub walks: u32,
    /// How many queries of each kind it took.
    pub collision_queries: u64,
    pub contact_queries: u64,
    pub distance_queries: u64,
}
gaps!(qdist_mesh_depth);
versioned!(qdist_mesh_depth);

impl qdist_mesh_depth {
    pub(super) fn new(found: &MeshDepth) -> Self {
        qdist_mesh_depth {
            struct_size: size_of::<qdist_mesh_depth>() as u32,
            outcome: outcome(found.outcome),
            lower: found.lower,
            upper: found.upper.min(f64::MAX),
            pose: qdist_mesh_pose::new(&found.pose),
            distance: found.distance.as_ref().map_or(qdist_mesh_distance::ZERO, qdist_mesh_distance::new),
            solid: found.solid.into(),
            walks: found.walks,
            collision_queries: found.counters.collision,
            contact_queries: found.counters.contact,
            distance_queries: found.counters.distance,
        }
    }
}

/// Writes the defaults, struct_size included.
///
/// Status: none but those of all functions.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_options_default(options: Out<qdist_mesh_options>) -> qdist_status {
    status(options.put(qdist_mesh_options::defaults()))
}

/// The depth of A at a pose. options: NULL for the defaults. Milliseconds; allocates while it runs, and keeps some of it in the pair.
///
/// With QDIST_MESH_SIGMA and no `mass`, an A that is no solid is QDIST_ERROR_MESH_NOT_SOLID, and so is one with a metric of yours that
/// is said to be at least QDIST_MESH_SIGMA. B may be a polygon soup.
///
/// Status: those of a pose (pose, any of options->poses) and of a metric; ARGUMENT (options->effort, or relative is negative), NONFINITE
/// (options->relative).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_pair_depth(
    pair: Out<qdist_mesh_pair>,
    pose: In<qdist_mesh_pose>,
    options: In<qdist_mesh_options>,
    depth: Out<qdist_mesh_depth>,
) -> qdist_status {
    guard(|| {
        depth.known()?;
        let (mut pair, pose, query) = (pair.get()?.0.take()?, pose.get()?.checked()?, Query::new(options)?);
        let model = pair.a.clone();
        let metric = query.metric.of(&model)?;
        let found = pair.ask(|searches| {
            let mut watch = |progress: &Progress| query.is_stopped(progress);
            let watch = query.given.watch.is_some().then_some(&mut watch as &mut dyn FnMut(&Progress) -> bool);
            searches.solver.depth(&pose, metric, &query.options(), watch)
        })?;
        depth.put_version(qdist_mesh_depth::new(&found))
    })
}

/// The caller's options, checked.
struct Query {
    given: qdist_mesh_options,
    metric: Chosen,
    effort: Effort,
    poses: Vec<Isometry3<f64>>,
}

impl Query {
    fn new(options: In<qdist_mesh_options>) -> Check<Query> {
        let given = options.or_default()?;
        let effort = effort(given.effort)?;
        not_negative(given.relative)?;
        let metric = Chosen::new(given.metric, given.mass, given.own)?;
        let poses = match given.pose_count {
            0 => Vec::new(),
            count => {
                let list = given.poses.array(Some(count as usize))?;
                list.iter().map(qdist_mesh_pose::checked).collect::<Check<_>>()?
            }
        };
        Ok(Query { given, metric, effort, poses })
    }

    fn options(&self) -> DepthOptions<'_> {
        let qdist_mesh_options { seed, max_queries, relative, .. } = self.given;
        let (effort, poses) = (self.effort, &self.poses[..]);
        DepthOptions { effort, seed, relative, max_queries, poses, ..DepthOptions::default() }
    }

    /// Asks the caller's function.
    fn is_stopped(&self, progress: &Progress) -> bool {
        let told = qdist_mesh_progress {
            lower: progress.lower,
            upper: progress.upper.min(f64::MAX),
            pose: qdist_mesh_pose::new(progress.pose),
            fraction: progress.fraction,
            queries: progress.queries,
        };
        // SAFETY: the header: `watch` may be called with `watch_user` during the call.
        self.given.watch.is_some_and(|watch| unsafe { watch(self.given.watch_user, &told) } != 0)
    }
}
