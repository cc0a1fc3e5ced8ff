//! The panic handler of the freestanding C library. No panic can be reached from the exported functions, which
//! `make purity` proves: with `must-not-panic` the handler calls a symbol that does not exist, so that a library in which a
//! panic is reachable does not link.

use core::panic::PanicInfo;

#[cfg(feature = "must-not-panic")]
unsafe extern "C" {
    fn qdist_panic_is_reachable() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    #[cfg(feature = "must-not-panic")]
    // SAFETY: never runs; a program with this call does not link.
    unsafe {
        qdist_panic_is_reachable()
    }
    #[cfg(not(feature = "must-not-panic"))]
    loop {
        core::hint::spin_loop();
    }
}
