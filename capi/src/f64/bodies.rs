//! Bodies in space and in the plane: what is the same in both. The structs of the header differ in their dimension, and in what only bodies in
//! space have; [`Placed`] is what they have in common.

use super::*;
use qdist::internal;
use qdist::support::{HalfSpace, Join, Rigid, Route, Symmetry};

/// What a body states about its set, beside what the set states itself.
#[derive(Clone, Copy)]
pub(super) struct Stated<const N: usize> {
    pub center: [f64; N],
    pub spread: f64,
    pub rolling_radius: f64,
    pub extents: [f64; N],
    pub errors: [f64; N],
    pub symmetry: u32,
    pub route: qdist_route,
    pub precise: qdist_precise_f64,
    pub unbounded: qdist_unbounded,
}

impl<const N: usize> Stated<N> {
    pub(super) const NOTHING: Self = Self {
        center: [0.0; N],
        spread: 0.0,
        rolling_radius: 0.0,
        extents: [0.0; N],
        errors: [0.0; N],
        symmetry: QDIST_SYMMETRY_NONE,
        route: None,
        precise: None,
        unbounded: None,
    };

    /// What a set of the library states.
    pub(super) fn of(set: &impl Support<f64, N>) -> Self {
        let center = set.center().map(|(center, spread)| (center.into(), spread.at_least(tiny())));
        let (center, spread) = center.unwrap_or(([0.0; N], 0.0));
        Self {
            center,
            spread,
            rolling_radius: set.rolling_radius(),
            extents: set.extents().into(),
            errors: set.errors().into(),
            symmetry: from_symmetry(set.symmetry()),
            route: Some(set.route().unwrap_or_else(Route::expansion).into_raw()),
            ..Self::NOTHING
        }
    }

    /// Are extents and errors stated axis by axis?
    fn by_axes(&self) -> bool {
        self.extents.iter().any(|&x| x > 0.0)
    }
}

fn from_symmetry(symmetry: Symmetry) -> u32 {
    match symmetry {
        Symmetry::None => QDIST_SYMMETRY_NONE,
        Symmetry::Axis => QDIST_SYMMETRY_AXIS,
        Symmetry::Full => QDIST_SYMMETRY_FULL,
    }
}

/// A body struct of the header: `qdist_body` in space, `qdist_body2` in the plane.
pub(super) trait Placed<const N: usize>: Copy + Gaps + 'static {
    /// In the identity pose.
    fn new(set: qdist_set_f64, stated: Stated<N>) -> Self;
    fn set(&self) -> &qdist_set_f64;
    fn stated(&self) -> Stated<N>;
    fn rotation(&self) -> SMatrix<f64, N, N>;
    fn translation(&self) -> Vector<f64, N>;

    /// Makes a body of a set that the caller has made.
    fn of_set(body: Out<Self>, set: In<qdist_set_f64>) -> Check {
        body.checked()?;
        let set = set.get()?;
        set.check(N)?;
        // (Whether it turns is said afterwards.)
        body.put(Self::new(*set, Stated { route: Some(Route::<f64>::axis().into_raw()), ..Stated::NOTHING }))
    }
}

/// `placed!(type, dimension, identity, fields that only this type has)`
macro_rules! placed {
    ($body:ty, $n:literal, $identity:expr $(, $own:ident)*) => {
        impl Placed<$n> for $body {
            fn new(set: qdist_set_f64, stated: Stated<$n>) -> Self {
                let Stated { center, spread, rolling_radius, extents, errors, precise, unbounded, .. } = stated;
                $(let $own = stated.$own;)*
                let (rotation, translation) = ($identity, [0.0; $n]);
                Self { set, rotation, translation, center, spread, rolling_radius, extents, errors, precise, unbounded, $($own),* }
            }
            #[inline(always)]
            fn set(&self) -> &qdist_set_f64 {
                &self.set
            }
            #[inline(always)]
            #[allow(clippy::needless_update)] // (Of a type that has all fields.)
            fn stated(&self) -> Stated<$n> {
                let &Self { center, spread, rolling_radius, extents, errors, precise, unbounded, $($own,)* .. } = self;
                Stated { center, spread, rolling_radius, extents, errors, precise, unbounded, $($own,)* ..Stated::NOTHING }
            }
            #[inline(always)]
            fn rotation(&self) -> SMatrix<f64, $n, $n> {
                SMatrix::from_row_slice(&self.rotation)
            }
            #[inline(always)]
            fn translation(&self) -> Vector<f64, $n> {
                Vector::from(self.translation)
            }
        }
    };
}
pub(super) use placed;

/// A body that has passed the checks, where it lies, as a [`Support`] in its own frame.
pub(super) struct Checked<'a, B>(&'a B);

// SAFETY: a checked body is seen during one call alone, which asks it from the thread that made the call.
unsafe impl<B> Sync for Checked<'_, B> {}

impl<'a, B> Checked<'a, B> {
    /// Checks the numbers, except for the pose, which [`place`](Self::place) does.
    #[inline(always)]
    pub(super) fn new<const N: usize>(body: &'a B) -> Check<Self>
    where
        B: Placed<N>,
    {
        body.set().check(N)?;
        let stated = body.stated();
        lengths([stated.spread, stated.rolling_radius])?;
        lengths(stated.extents)?;
        lengths(stated.errors)?;
        if stated.spread > 0.0 {
            coordinates(&stated.center)?;
        }
        if stated.rolling_radius > body.set().radius || stated.symmetry > QDIST_SYMMETRY_FULL {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        Ok(Self(body))
    }

    /// The body in its pose.
    #[inline(always)]
    pub(super) fn place<const N: usize>(&self) -> Result<Body<'_, f64, N>, BodyError>
    where
        B: Placed<N>,
    {
        Body::new(self, self.0.rotation(), self.0.translation())
    }
}

impl<B: Placed<N>, const N: usize> Support<f64, N> for Checked<'_, B> {
    #[inline]
    fn support(&self, u: &Vector<f64, N>) -> Result<Vector<f64, N>, Failure> {
        self.0.set().farthest(u, false)
    }
    fn exhaustive(&self, u: &Vector<f64, N>) -> Result<(Vector<f64, N>, Vector<f64, N>), Failure> {
        self.0.set().farthest(u, true).map(|p| (p, p))
    }
    fn has_shortcuts(&self) -> bool {
        self.0.set().exhaustive.is_some()
    }
    fn radius(&self) -> f64 {
        self.0.set().radius
    }
    fn rolling_radius(&self) -> f64 {
        self.0.stated().rolling_radius
    }
    fn extent(&self) -> f64 {
        self.0.set().extent
    }
    fn center(&self) -> Option<(Vector<f64, N>, f64)> {
        let stated = self.0.stated();
        (stated.spread > 0.0).then(|| (Vector::from(stated.center), stated.spread))
    }
    fn symmetry(&self) -> Symmetry {
        match self.0.stated().symmetry {
            QDIST_SYMMETRY_AXIS => Symmetry::Axis,
            QDIST_SYMMETRY_FULL => Symmetry::Full,
            _ => Symmetry::None,
        }
    }
    fn route(&self) -> Option<Route<f64>> {
        // SAFETY: what the header asks of the caller: what a body function of this scalar type has written, or NULL.
        self.0.stated().route.map(|route| unsafe { Route::from_raw(route) })
    }
    fn contains_origin(&self) -> bool {
        self.0.set().knows_origin(N)
    }
    fn error(&self) -> f64 {
        self.0.set().stated_error(N)
    }
    fn support_in_two_words(&self, u: &TwoWords<f64, N>) -> Option<TwoWords<f64, N>> {
        let function = self.0.stated().precise?;
        // SAFETY: the header: the function may be called with the set's `user`.
        unsafe { precise(function, self.0.set().user, u) }
    }
    fn errors(&self) -> Vector<f64, N> {
        let stated = self.0.stated();
        if stated.by_axes() { Vector::from(stated.errors) } else { Vector::repeat(self.0.set().stated_error(N)) }
    }
    fn extents(&self) -> Vector<f64, N> {
        let stated = self.0.stated();
        if stated.by_axes() { Vector::from(stated.extents) } else { Vector::repeat(self.0.set().extent) }
    }
}

// ------------------------------------------------------------------------------------------------- hulls of two bodies

/// A struct of two bodies: `qdist_join`, `qdist_join2`.
pub(super) trait Joined<const N: usize>: 'static {
    type Body: Placed<N>;
    fn bodies(&self) -> [&In<Self::Body>; 2];

    /// Makes a body of their hull.
    fn fill(body: Out<Self::Body>, join: In<Self>) -> Check
    where
        Self: Sized,
    {
        body.checked()?;
        let parts = join.get()?;
        let set = hull(parts)?;
        for part in parts.bodies() {
            // The pose as queries check it.
            Checked::new(part.get()?)?.place().map_err(from_body)?;
        }
        let made = qdist_set_f64 {
            support: support_of::<Hull<Self>, N>(),
            exhaustive: if set.has_shortcuts() { exhaustive_of::<Hull<Self>, N>() } else { None },
            user: join.user(),
            ..qdist_set_f64::stated_by(&set)
        };
        let (symmetry, rolling_radius) = (from_symmetry(set.symmetry()), set.rolling_radius());
        let route = Some(Route::<f64>::axis().into_raw());
        let made = Self::Body::new(made, Stated { symmetry, rolling_radius, route, ..Stated::NOTHING });
        // A measured extent may be infinite.
        Checked::new(&made)?;
        body.put(made)
    }
}

type Part<'a, B, const N: usize> = Rigid<Checked<'a, B>, f64, N>;
type Both<'a, B, const N: usize> = Join<Part<'a, B, N>, Part<'a, B, N>>;

fn hull<J: Joined<N>, const N: usize>(join: &J) -> Check<Both<'_, J::Body, N>> {
    let [a, b] = join.bodies();
    Ok(Join::new(part(a)?, part(b)?))
}

#[inline(always)]
fn part<B: Placed<N>, const N: usize>(body: &In<B>) -> Check<Part<'_, B, N>> {
    let body = body.get()?;
    if body.stated().unbounded.is_some() {
        return Err(QDIST_ERROR_UNBOUNDED);
    }
    Rigid::new(Checked::new(body)?, body.rotation(), body.translation()).map_err(from_shape)
}

/// The support function of a struct of two bodies.
struct Hull<J>(core::marker::PhantomData<J>);

impl<J: Joined<N>, const N: usize> Answers<N> for Hull<J> {
    type Struct = J;
    fn farthest(join: &J, u: &Vector<f64, N>, exhaustive: bool) -> Check<Vector<f64, N>> {
        let set = hull(join)?;
        let farthest = if exhaustive { set.exhaustive(u).map(|(point, _)| point) } else { set.support(u) };
        farthest.map_err(|Failure(code)| code)
    }
}

// ------------------------------------------------------------------------------------------------- half spaces

/// A struct of a half space: `qdist_half_space`, `qdist_half_plane`.
pub(super) trait Half<const N: usize>: 'static {
    type Body: Placed<N>;
    fn set(&self) -> Check<HalfSpace<f64, N>>;

    /// Makes a body of it, whose depth is an answer of its own.
    fn fill(body: Out<Self::Body>, shape: In<Self>) -> Check
    where
        Self: Sized,
    {
        body.checked()?;
        shape.get()?.set()?;
        let set =
            qdist_set_f64 { support: Some(refuse), user: shape.user(), dimension: N as u32, ..qdist_set_f64::ZERO };
        body.put(Self::Body::new(set, Stated { unbounded: Some(answer::<Self, N>), ..Stated::NOTHING }))
    }
}

/// There is no farthest point.
unsafe extern "C" fn refuse(_user: *mut c_void, _direction: *const f64, _point: *mut f64) -> i32 {
    QDIST_ERROR_UNBOUNDED
}

/// A body of either kind.
enum Either<'a, B: Placed<N>, const N: usize> {
    Half(HalfSpace<f64, N>, &'a B),
    Compact(Checked<'a, B>),
}

impl<'a, B: Placed<N>, const N: usize> Either<'a, B, N> {
    fn new<H: Half<N, Body = B>>(body: &'a In<B>) -> Check<Self> {
        let body = body.get()?;
        if body.stated().unbounded.is_some() {
            // SAFETY: what the header asks of the caller: with this function, that is what `user` points to.
            let shape = unsafe { In::<H>::new(body.set().user.cast()) };
            return Ok(Either::Half(shape.get()?.set()?, body));
        }
        Checked::new(body).map(Either::Compact)
    }

    fn place(&self) -> Result<Body<'_, f64, N>, BodyError> {
        match self {
            Either::Compact(body) => body.place(),
            Either::Half(shape, body) => Body::new(shape, body.rotation(), body.translation()),
        }
    }
}

/// The query of two bodies, one of which is a half space.
unsafe extern "C" fn answer<H: Half<N>, const N: usize>(
    a: *const c_void,
    b: *const c_void,
    options: *const c_void,
    result: *mut c_void,
) -> qdist_status {
    // SAFETY: the arguments of `depth`.
    let (a, b, options, result) = unsafe {
        let options = In::<qdist_options_f64>::new(options.cast());
        (
            In::<H::Body>::new(a.cast()),
            In::<H::Body>::new(b.cast()),
            options,
            Out::<qdist_depth_f64>::new(result.cast()),
        )
    };
    status_of(|| {
        let (a, b) = (Either::new::<H>(&a)?, Either::new::<H>(&b)?);
        let (options, _) = convert::<N>(options)?;
        let (a, b) = (a.place().map_err(from_body)?, b.place().map_err(from_body)?);
        let depth = internal::unbounded(&a, &b, &options).ok_or(QDIST_ERROR_UNBOUNDED)?;
        overflow(depth.failure)?;
        result.put_version(from_depth(&depth))?;
        conclude(depth.outcome)
    })
}

// ------------------------------------------------------------------------------------------------------------- query

/// Depth of two bodies; `query` asks the solver. `None`: a body has no route.
#[inline(always)]
pub(super) fn depth<B: Placed<N>, const N: usize>(
    solver: Out<qdist_solver>,
    a: In<B>,
    b: In<B>,
    options: In<qdist_options_f64>,
    result: Out<qdist_depth_f64>,
    query: impl FnOnce(&mut Solver<'_, f64, N>, [&Body<'_, f64, N>; 2], &Options<'_, f64, N>) -> Option<Depth<f64, N>>,
) -> Check {
    result.checked()?;
    let (one, other) = (a.get()?, b.get()?);
    let mut solver = handle::open::<f64, N>(&solver)?;
    result.known()?;
    if let Some(answer) = one.stated().unbounded.or(other.stated().unbounded) {
        let (a, b, options) = (a.address().cast(), b.address().cast(), options.address().cast());
        // SAFETY: a function of this library for these arguments, which are checked.
        let status = unsafe { answer(a, b, options, result.address().cast()) };
        return super::super::status::from_status(status);
    }
    let (one, other, options) = (Checked::new(one)?, Checked::new(other)?, convert::<N>(options));
    // Taken by reference out of their `Result`s: to move a large struct that was just written takes long.
    let (one, other) = (one.place(), other.place());
    let depth = match (&one, &other, &options) {
        (Ok(a), Ok(b), Ok((options, deadline))) => {
            deadline.during(options, |options| query(&mut solver, [a, b], options)).ok_or(QDIST_ERROR_ARGUMENT)?
        }
        (_, _, Err(status)) => return Err(*status),
        (Err(error), ..) | (_, Err(error), _) => return Err(from_body(*error)),
    };
    overflow(depth.failure)?;
    result.put_version(from_depth(&depth))?;
    conclude(depth.outcome)
}
