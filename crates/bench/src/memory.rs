//! Memory of this process, as far as the system reports it.

use std::fs;

/// The largest resident memory in bytes since the start or the last [`forget_peak`]; `None` but on Linux.
pub fn peak() -> Option<usize> {
    status("VmHWM:")
}

/// Resident memory in bytes; `None` but on Linux.
pub fn resident() -> Option<usize> {
    status("VmRSS:")
}

/// Resets the peak where the system can; without it the peak is that since the start.
pub fn forget_peak() {
    // 5 resets VmHWM, see proc_pid_clear_refs(5).
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// The largest resident memory in bytes of another process so far; `None` but on Linux, and where it is gone.
pub fn peak_of(process: u32) -> Option<usize> {
    of(&process.to_string(), "VmHWM:")
}

fn status(name: &str) -> Option<usize> {
    of("self", name)
}

fn of(process: &str, name: &str) -> Option<usize> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let value = status.lines().find_map(|line| line.strip_prefix(name))?;
    value.trim().strip_suffix("kB")?.trim().parse::<usize>().ok().map(|kilobytes| 1024 * kilobytes)
}
