//! What is inside of a pair and of a tracker: something that borrows from two meshes, and the meshes, shared with whoever else has them.

use super::*;
use std::sync::Arc;

pub(super) struct Between<S> {
    /// Before what it borrows from, so that it is dropped first.
    pub(super) inside: S,
    pub(super) a: Arc<Model>,
    b: Arc<Model>,
    make: fn(&'static Model, &'static Model) -> S,
}

impl<S> Between<S> {
    /// Of meshes of the caller, for one call at a time.
    pub(super) fn of(
        a: In<qdist_mesh>,
        b: In<qdist_mesh>,
        make: fn(&'static Model, &'static Model) -> S,
    ) -> Check<Exclusive<Self>> {
        Ok(Exclusive::new(Self::new(a.get()?.model.clone(), b.get()?.model.clone(), make)))
    }

    fn new(a: Arc<Model>, b: Arc<Model>, make: fn(&'static Model, &'static Model) -> S) -> Self {
        // SAFETY: the models live at fixed addresses, are never written to, and are kept by the fields beside what is made,
        // which nothing takes out of this struct.
        let [one, two]: [&'static Model; 2] = unsafe { [&*Arc::as_ptr(&a), &*Arc::as_ptr(&b)] };
        Self { inside: make(one, two), a, b, make }
    }

    /// Asks what is inside. A panic leaves it as new.
    pub(super) fn ask<R>(&mut self, question: impl FnOnce(&mut S) -> R) -> Check<R> {
        let answer = caught(|| question(&mut self.inside));
        answer.ok_or_else(|| {
            *self = Self::new(self.a.clone(), self.b.clone(), self.make);
            QDIST_ERROR_INTERNAL
        })
    }
}

/// Threads may pass pairs and trackers on, and share meshes, as the header says.
const _: () = {
    const fn passed<T: Send>() {}
    const fn shared<T: Send + Sync>() {}
    passed::<qdist_mesh_pair>();
    passed::<qdist_mesh_tracker>();
    shared::<qdist_mesh>();
};
