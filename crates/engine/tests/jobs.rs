//! Jobs that do not start, and jobs that end before they should.

use crate::launched::{launch, mumps, square};
use frfit_engine::{Launch, Mumps};
use frfit_linalg::solve::{Breakdown, Engine};
use std::process::Command;
use std::time::{Duration, Instant};

fn refused(launch: &Launch) -> String {
    Mumps::start(launch).unwrap_err().to_string()
}

#[test]
fn a_launcher_that_is_not_there_is_named() {
    let words = refused(&Launch::by("no-such-launcher -n 2"));
    assert!(words.starts_with("\"no-such-launcher\" cannot be run: "), "{words}");
    assert_eq!(refused(&Launch::by("")), "expected a command that starts the ranks, found an empty text");
}

#[test]
#[cfg(unix)]
fn a_job_that_ends_at_once_says_why() {
    let mut launch = Launch::by("sh -c");
    launch.command.push("printf 'no slots\\033[31m\\n' >&2; exit 3; #".into());
    assert_eq!(refused(&launch), "the ranks ended before they were ready: no slots[31m");
}

#[test]
#[cfg(unix)]
fn a_job_that_never_calls_is_given_up() {
    let mut launch = Launch::by("sh -c");
    launch.command.push("sleep 60; #".into());
    launch.patience = Duration::from_millis(300);
    let start = Instant::now();
    assert_eq!(refused(&launch), "the ranks did not start within 0 s");
    assert!(start.elapsed() < Duration::from_secs(10));
}

#[test]
#[ignore = "needs MUMPS"]
#[cfg(target_os = "linux")]
fn a_rank_that_is_killed_is_an_error_now_and_later_needs_mumps() {
    let matrix = square(150, 1.3);
    let values = matrix.real_values().unwrap();
    // Before a factor, while it is made, and before a solution.
    for delay in [0, 5, 30, 200] {
        let mumps = mumps(3);
        let analysis = mumps.analyse(matrix.pattern());
        let killer = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(delay));
            kill_last_rank_of(std::process::id());
            Instant::now()
        });
        let outcome = loop {
            match analysis.factor(values).and_then(|factor| factor.solve(&mut vec![1.0; matrix.dim()])) {
                Ok(_) => {}
                Err(breakdown) => break breakdown,
            }
        };
        assert!(killer.join().unwrap().elapsed() < Duration::from_secs(10));
        let Breakdown::Engine(words) = &outcome else { panic!("{outcome:?}") };
        assert!(words.starts_with("mumps: the ranks have ended: ") && words.contains("signal 9"), "{words}");
        assert_eq!(analysis.factor(values).unwrap_err(), outcome);
    }
}

/// The youngest grandchild of a process, by the launcher.
fn kill_last_rank_of(process: u32) {
    let list = |of: u32| {
        let output = Command::new("ps").args(["-o", "pid=", "--ppid", &of.to_string()]).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        text.split_whitespace().map(|pid| pid.parse().unwrap()).collect::<Vec<u32>>()
    };
    let rank = list(process).into_iter().flat_map(list).max().unwrap();
    assert!(Command::new("kill").args(["-9", &rank.to_string()]).status().unwrap().success());
}

#[test]
#[ignore = "needs MUMPS"]
fn a_folder_that_is_not_there_is_an_error_needs_mumps() {
    let mut launch = launch(1);
    launch.out_of_core = Some("/no/such/folder".into());
    let mumps = Mumps::start(&launch).unwrap();
    let matrix = square(40, 1.3);
    let outcome = mumps.analyse(matrix.pattern()).factor(matrix.real_values().unwrap()).unwrap_err();
    assert!(matches!(outcome, Breakdown::Engine(_)), "{outcome:?}");
}
