//! What valgrind's headers do with macros: a request is a sequence of instructions that does nothing, unless valgrind sees it.

/// Counts begin anew.
pub fn zero() {
    request(BASE + 1);
}

/// Counts are written to a file.
pub fn dump() {
    request(BASE);
}

/// `VG_USERREQ_TOOL_BASE('C', 'T')`
const BASE: usize = 0x4354_0000;

#[cfg(target_arch = "x86_64")]
fn request(request: usize) {
    let words = [request, 0, 0, 0, 0, 0];
    // SAFETY: rdi is rotated by 128 bits in all, and rbx exchanged with itself; valgrind reads the words, and writes to rdx.
    unsafe {
        std::arch::asm!(
            "rol rdi, 3",
            "rol rdi, 13",
            "rol rdi, 61",
            "rol rdi, 51",
            "xchg rbx, rbx",
            in("rax") words.as_ptr(),
            inout("rdx") 0_usize => _,
        );
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn request(_: usize) {}
