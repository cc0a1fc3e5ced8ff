//! What every file of this crate speaks of. C has one namespace, and the names of the header have one here, too: a file begins with `use super::*`
//! (folders pass this on, and add what their chapters share), and imports besides only what no other file needs.

pub(crate) use crate::callback::*;
#[cfg(feature = "grasp")]
pub(crate) use crate::grasp::*;
pub(crate) use crate::handle::{self, qdist_solver};
pub(crate) use crate::layout::*;
pub(crate) use crate::numbers::*;
pub(crate) use crate::pointer::*;
pub(crate) use crate::status::*;
pub(crate) use crate::symmetry::*;
pub(crate) use core::ffi::{c_char, c_void};
pub(crate) use core::marker::PhantomData;
pub(crate) use qdist::internal::{alone, one_by_one};
pub(crate) use qdist::support::{Failure, Support};
pub(crate) use qdist::{Answer, Body, BodyError, Depth, Options, Outcome, Plan, Real, Solver, TwoWords, Vector};
