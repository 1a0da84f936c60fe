//! One step of a chore: a command with a name, its seconds, and the lines that sum it up.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Instant;

/// What became of a step.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    pub(crate) seconds: f64,
    pub(crate) passed: bool,
    /// Lines of the output with which a test runner sums up.
    pub(crate) closing: Vec<String>,
}

/// The folder of the workspace.
pub(crate) fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// The build folder, however it was chosen: this program lies two levels below.
pub(crate) fn target() -> PathBuf {
    let own = std::env::current_exe().unwrap_or_default();
    own.ancestors().nth(2).map_or_else(|| workspace().join("target"), Path::to_owned)
}

/// The cargo that runs this program, in the workspace.
pub(crate) fn cargo<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(workspace());
    if std::io::stderr().is_terminal() && std::env::var_os("CARGO_TERM_COLOR").is_none() {
        // The output passes through a pipe, which cargo takes for a file.
        command.env("CARGO_TERM_COLOR", "always");
    }
    command
}

/// Whether a command is there: it is called with `arguments` (such as `--version`) and succeeds.
pub(crate) fn works(command: &mut Command) -> bool {
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Runs a command, passing its output on.
pub(crate) fn run(name: &'static str, command: &mut Command) -> Step {
    println!("── {name}");
    let start = Instant::now();
    let mut step = Step { name, seconds: 0.0, passed: false, closing: Vec::new() };
    match command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn() {
        Ok(mut child) => {
            let (out, err) = (child.stdout.take(), child.stderr.take());
            step.closing = thread::scope(|scope| {
                let err = scope.spawn(|| err.map(|pipe| pass_on(pipe, std::io::stderr())));
                let mut lines = out.map(|pipe| pass_on(pipe, std::io::stdout())).unwrap_or_default();
                lines.extend(err.join().ok().flatten().unwrap_or_default());
                lines
            });
            step.passed = child.wait().is_ok_and(|status| status.success());
        }
        Err(error) => eprintln!("{}: {error}", command.get_program().display()),
    }
    step.seconds = start.elapsed().as_secs_f64();
    step
}

/// Runs a command beside others: what it says is passed on as a whole, at its end.
pub(crate) fn run_beside(name: &'static str, command: &mut Command) -> Step {
    let start = Instant::now();
    let output = command.output();
    let seconds = start.elapsed().as_secs_f64();
    let mut own = std::io::stdout().lock();
    let _ = writeln!(own, "── {name}");
    match output {
        Ok(Output { status, stdout, stderr }) => {
            let mut closing = pass_on(&stdout[..], &mut own);
            closing.extend(pass_on(&stderr[..], std::io::stderr()));
            Step { name, seconds, passed: status.success(), closing }
        }
        Err(error) => {
            eprintln!("{}: {error}", command.get_program().display());
            Step { name, seconds, passed: false, closing: Vec::new() }
        }
    }
}

/// Copies line by line, and returns the lines with which the runner sums up: of cargo test one for each program, of
/// cargo-nextest its summary and all that follows, which names the tests that failed.
fn pass_on(pipe: impl Read, mut to: impl Write) -> Vec<String> {
    let (mut pipe, mut line, mut closing) = (BufReader::new(pipe), Vec::new(), Vec::new());
    let mut summary = false;
    while pipe.read_until(b'\n', &mut line).is_ok_and(|bytes| bytes > 0) {
        // Whoever reads our output may have left; the step still runs to its end.
        let _ = to.write_all(&line).and_then(|()| to.flush());
        let text = String::from_utf8_lossy(&line);
        // "tests run", or "test run" of one; a failed test's own output may hold the other words.
        summary |= text.contains(" Summary") && text.contains(" run: ");
        if summary || text.starts_with("test result:") {
            closing.push(text.trim().to_owned());
        }
        line.clear();
    }
    closing
}

/// Prints the closing lines and the seconds of each step; true where all passed.
pub(crate) fn sum_up(steps: &[Step]) -> bool {
    println!("── summary");
    steps.iter().flat_map(|step| &step.closing).for_each(|line| println!("{line}"));
    for Step { name, seconds, passed, .. } in steps {
        println!("{name:<14} {seconds:>7.1} s  {}", if *passed { "passed" } else { "FAILED" });
    }
    steps.iter().all(|step| step.passed)
}
