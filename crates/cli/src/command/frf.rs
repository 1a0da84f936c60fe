//! `frfit frf`

use super::{one_on_standard_output, say_beside, say_json};
use crate::args::{Args, Frf};
use crate::outcome::{Failure, Outcome};
use frfit::signal::{Options, Windows};
use frfit_workflow::job::frf_of_records;
use frfit_workflow::output::is_stream;
use frfit_workflow::records::ChannelOptions;

pub(crate) fn run(args: &Args, wanted: &Frf) -> Result<Outcome, Failure> {
    let channels = ChannelOptions {
        force: wanted.force.clone(),
        responses: wanted.responses.clone(),
        force_unit: wanted.force_unit,
        response_unit: wanted.response_unit,
        force_sensitivity: wanted.force_sensitivity,
        response_sensitivity: wanted.response_sensitivity,
        force_dof: wanted.force_dof,
        response_dofs: wanted.response_dofs.clone(),
    };
    let usual = Options::default();
    let windows =
        Windows::default().with_force_s(wanted.force_window).with_exponential_s(wanted.exponential_window);
    let options = Options::default()
        .with_estimator(wanted.estimator.unwrap_or(usual.estimator))
        .with_trigger_n(wanted.trigger)
        .with_pre_trigger_s(wanted.pre_trigger)
        .with_length_s(wanted.length)
        .with_double_impact(wanted.double_impact.unwrap_or(usual.double_impact))
        .with_drift(wanted.drift.unwrap_or(usual.drift))
        .with_windows(windows)
        .with_keep(wanted.keep.clone());
    one_on_standard_output(args, &wanted.out)?;
    let job = frf_of_records(&wanted.records, &channels, &options, &wanted.out, wanted.to.as_deref())?;
    if args.json {
        say_json(&job.summary)?;
    } else {
        let name = wanted.out.with_extension("");
        let name = name.display();
        let beside = match is_stream(&wanted.out) {
            true => String::new(),
            false => format!(", {name}-summary.json, {name}-figures/"),
        };
        let mut words = job.text;
        words.say(&format!("  {:<8}{}{beside}\n", "wrote", wanted.out.display()));
        say_beside(args, &wanted.out, &words)?;
    }
    Ok(Outcome::Done)
}
