//! The panic handler of the freestanding C library. No panic can be reached from the exported functions, which
//! `./x purity` proves: with `must-not-panic` the handler calls a symbol that does not exist, so that a library in which a
//! panic is reachable does not link.

use core::panic::PanicInfo;

// The compiler's own functions, which every static library brings along, were built for unwinding and name the function that would sort out an
// unwinding stack. None unwinds. A program that uses one of them, for __float128 say, must link all the same: so the name is there, as
// a weak one, so that another library may have it too.
#[cfg(not(any(windows, target_vendor = "apple", target_family = "wasm")))]
core::arch::global_asm!(".weak rust_eh_personality", ".set rust_eh_personality, 0");

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
