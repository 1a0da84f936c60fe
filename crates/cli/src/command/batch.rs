//! `frfit batch`

use super::{megabytes, one_on_standard_output, say, say_beside, say_json, say_words};
use crate::args::{Args, Batch, BatchAction, BatchPlan, BatchRun, Collect};
use crate::outcome::{Failure, Outcome};
use crate::progress::Progress;
use frfit_workflow::Reads;
use frfit_workflow::batch::{
    BatchOptions, Detail, Plan, Retry, Shard, batch_status, collect, run_batch, sbatch_script,
};
use frfit_workflow::output::{Words, write_one};
use serde_json::{Value, json};

/// Of the runs that failed so many are said.
const MAX_REASONS: usize = 5;

pub(crate) fn run(args: &Args, batch: &Batch) -> Result<Outcome, Failure> {
    match (&batch.action, &batch.run) {
        (Some(BatchAction::Status(plan)), _) => status(args, plan),
        (Some(BatchAction::Collect(wanted)), _) => collected(args, wanted),
        (None, Some(run)) => runs(args, run),
        (None, None) => Err(Failure::Input("frfit batch: expected a plan, found none".into())),
    }
}

fn runs(args: &Args, run: &BatchRun) -> Result<Outcome, Failure> {
    let BatchRun { plan: file, out, reduced, .. } = run;
    if let Some(tasks) = run.print_sbatch {
        say(&sbatch_script(file, out, reduced.as_deref(), tasks))?;
        return Ok(Outcome::Done);
    }
    let plan = Plan::read(file)?;
    let of_slurm = || Shard::of_slurm(|name| std::env::var(name).ok());
    let options = BatchOptions {
        shard: run.shard.or_else(of_slurm).unwrap_or_default(),
        jobs: run.jobs.map(usize::from),
        retry: if run.retry.is_some() { Retry::Failed } else { Retry::Nothing },
        reduced: reduced.clone(),
        memory_bytes: run.memory.map(megabytes),
    };
    let progress = Progress::of("runs", args.quiet || args.json);
    let done = run_batch(&plan, out, &options, &|done, total| progress.show(done, total));
    progress.end();
    let done = done?;
    if args.json {
        let failed: Vec<Value> =
            done.failed.iter().map(|(row, error)| json!({"row": row, "error": error})).collect();
        say_json(&json!({
            "rows": done.rows,
            "kept": done.kept,
            "done": done.done,
            "left_failed": done.left_failed,
            "failed": failed,
            "seconds": done.seconds,
        }))?;
    } else {
        let mut words = Words::default();
        let there = if done.kept > 0 { format!(", {} were there", done.kept) } else { String::new() };
        words.say(&format!("{} of {} runs done{there} ({:.1} s)\n", done.done, done.rows, done.seconds));
        for (row, error) in done.failed.iter().take(MAX_REASONS) {
            words.warn(&format!("row {row} failed: {}\n", error.replace('\n', "; ")));
        }
        let more = done.failed.len().saturating_sub(MAX_REASONS);
        if more > 0 {
            words.warn(&format!("and {more} more failed\n"));
        }
        if done.left_failed > 0 {
            words.warn(&format!("{} failed before (--retry failed does them again)\n", done.left_failed));
        }
        say_words(args, &words)?;
    }
    let all = done.failed.is_empty() && done.left_failed == 0;
    Ok(if run.strict && !all { Outcome::NotTrusted } else { Outcome::Done })
}

fn status(args: &Args, wanted: &BatchPlan) -> Result<Outcome, Failure> {
    let plan = Plan::read(&wanted.plan)?;
    let status = batch_status(&plan, &wanted.out, wanted.reduced.as_deref())?;
    let missing = status.missing();
    if args.json {
        let json =
            json!({"rows": status.rows, "done": status.done, "failed": status.failed, "missing": missing});
        say_json(&json)?;
    } else {
        say(&format!(
            "{} runs: {} done, {} failed, {missing} missing\n",
            status.rows, status.done, status.failed
        ))?;
    }
    Ok(Outcome::Done)
}

fn collected(args: &Args, wanted: &Collect) -> Result<Outcome, Failure> {
    one_on_standard_output(args, &wanted.out)?;
    let detail = if wanted.lines { Detail::Lines } else { Detail::Runs };
    let table = collect(&wanted.store, detail)?;
    let rows = table.csv.lines().count() - 1;
    write_one(&wanted.out, table.csv.into_bytes(), &Reads::default())?;
    if args.json {
        say_json(&json!({"runs": table.runs, "failed": table.failed, "rows": rows}))?;
        return Ok(Outcome::Done);
    }
    let mut words = Words::default();
    words.say(&format!("{}: {rows} rows of {} runs\n", wanted.out.display(), table.runs));
    if table.failed > 0 {
        words.warn(&format!("{} runs failed\n", table.failed));
    }
    say_beside(args, &wanted.out, &words)?;
    Ok(Outcome::Done)
}
