//! x
pub fn draw(_folder: &std::path::Path, _solver: &mut qdist::Solver<'_, f64, 6>, _grasp: &crate::Grasp, _i: usize, _w: &crate::query::Wrenches, _f: &crate::query::Found) -> Result<(), String> { Ok(()) }
