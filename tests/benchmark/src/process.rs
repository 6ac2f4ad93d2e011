//! What the operating system says of this process.

/// Memory of this process in bytes: resident now, and at most so far. `None` where there is no `/proc`.
pub fn resident() -> Option<(u64, u64)> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let field = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name))?;
        let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kib * 1024)
    };
    Some((field("VmRSS:")?, field("VmHWM:")?))
}

/// Processors that this process may use.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// What keeps glibc from giving memory back to the system after each candidate, which then pays for getting it again.
const STEADY: [(&str, &str); 2] = [("MALLOC_TRIM_THRESHOLD_", "1073741824"), ("MALLOC_TOP_PAD_", "67108864")];

/// Runs this program again as one whose memory stays its own, and says how that ended; `None` in that program itself.
///
/// # Errors
/// It cannot be started.
pub fn steadily() -> Result<Option<bool>, String> {
    if STEADY.iter().all(|(name, _)| std::env::var_os(name).is_some()) {
        return Ok(None);
    }
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let mut command = std::process::Command::new(program);
    let status = command.args(std::env::args_os().skip(1)).envs(STEADY).status();
    status.map(|status| Some(status.success())).map_err(|e| e.to_string())
}
