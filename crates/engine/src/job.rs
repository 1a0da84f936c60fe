//! The process that holds the ranks: a launcher, whose words say what became of them.

use std::io::Read;
use std::process::Child;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Bytes of a job's words that are kept.
const MAX_WORDS: usize = 1 << 14;

/// The process that holds the ranks, and what it wrote.
#[derive(Debug)]
pub(crate) struct Job {
    pub(crate) child: Child,
    words: Arc<Mutex<Vec<u8>>>,
    reader: Option<JoinHandle<()>>,
}

impl Job {
    /// Collects from now on what a process writes to standard error.
    pub(crate) fn of(mut child: Child) -> Self {
        let words = Arc::new(Mutex::new(Vec::new()));
        let reader = child.stderr.take().map(|mut stderr| {
            let words = Arc::clone(&words);
            std::thread::spawn(move || {
                let mut piece = [0; 1024];
                while let Ok(count @ 1..) = stderr.read(&mut piece) {
                    let mut words = words.lock().unwrap_or_else(PoisonError::into_inner);
                    let room = MAX_WORDS.saturating_sub(words.len());
                    words.extend(&piece[..count.min(room)]);
                }
            })
        });
        Self { child, words, reader }
    }

    pub(crate) fn has_ended(&mut self) -> bool {
        !matches!(self.child.try_wait(), Ok(None))
    }

    /// What it wrote to standard error, without control characters and without the frames that launchers draw.
    pub(crate) fn words(&mut self) -> String {
        if self.has_ended()
            && let Some(reader) = self.reader.take()
        {
            let _ = reader.join(); // so that nothing of it is missing
        }
        let bytes = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        let text = String::from_utf8_lossy(&bytes);
        let lines = text.lines().map(|line| line.chars().filter(|one| !one.is_control()).collect::<String>());
        let lines = lines.filter(|line| line.chars().any(char::is_alphanumeric));
        lines.map(|line| line.trim().to_owned()).collect::<Vec<_>>().join(" ")
    }

    /// Waits for its end, and makes it end where it does not.
    pub(crate) fn end(&mut self, patience: Duration) {
        let start = Instant::now();
        while !self.has_ended() && start.elapsed() < patience {
            std::thread::sleep(Duration::from_millis(5));
        }
        if !self.has_ended() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}
