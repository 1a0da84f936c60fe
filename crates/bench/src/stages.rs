//! CPU seconds by stage of an identification.

use cpu_time::ProcessTime;
use frfit::identify::Stage;
use std::sync::{Mutex, PoisonError};

/// CPU seconds of all threads, each stage from when it was first heard of to when another was.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stages {
    /// Training, and what is done before the first frequency's solutions are there.
    pub subspace: f64,
    /// Solutions at every frequency.
    pub solutions: f64,
    /// The choice among them, and the certificates.
    pub selection: f64,
}

/// Hears which stage is on, from any thread.
#[derive(Debug)]
pub struct StageClock(Mutex<(Stages, Option<Stage>, ProcessTime)>);

impl Stages {
    /// Starts.
    pub fn clock() -> StageClock {
        StageClock(Mutex::new((Self::default(), None, ProcessTime::now())))
    }
}

impl StageClock {
    /// The stage is on.
    pub fn enter(&self, stage: Stage) {
        self.change(Some(stage));
    }

    /// All is done.
    pub fn stop(self) -> Stages {
        self.change(None);
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).0
    }

    fn change(&self, next: Option<Stage>) {
        // A thread that panicked takes the benchmark down with it.
        let mut guard = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (stages, current, since) = &mut *guard;
        if *current == next {
            return;
        }
        let elapsed = since.elapsed().as_secs_f64();
        match current {
            Some(Stage::Subspace) => stages.subspace += elapsed,
            Some(Stage::Solutions) => stages.solutions += elapsed,
            Some(Stage::Selection) => stages.selection += elapsed,
            Some(_) | None => {}
        }
        (*current, *since) = (next, ProcessTime::now());
    }
}
