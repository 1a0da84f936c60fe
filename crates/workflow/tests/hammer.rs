//! Real hammer tests, from file to FRF.

use crate::picture::assert_shows_something;
use crate::shared_data;

use frfit::c64;
use frfit::quantity::Quantity;
use frfit::signal::{Estimator, Fault, Options, estimate_frf};
use frfit_workflow::job::{FrfJob, frf_of_records};
use frfit_workflow::load::{Choice, load_frf};
use frfit_workflow::records::{ChannelOptions, read_records};
use shared_data::{python_with, shared};
use std::path::Path;
use std::process::Command;

fn job(file: &Path, options: &Options, out: &Path) -> FrfJob {
    frf_of_records(&[file.to_path_buf()], &ChannelOptions::default(), options, out, None).unwrap()
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn of_five_hits_a_spike_and_a_double_impact_are_left_out_needs_data() {
    let file = shared("hammer/impact2_response0.lvm");
    let folder = tempfile::tempdir().unwrap();
    let FrfJob { measured, summary, text, .. } =
        job(&file, &Options::default(), &folder.path().join("frf.uff"));
    assert_eq!((measured.impacts.len(), measured.samples), (5, 51200));
    let kept: Vec<bool> = measured.impacts.iter().map(|impact| impact.is_kept()).collect();
    assert_eq!(kept, [false, true, false, true, true]);
    assert!(
        matches!(measured.impacts[0].faults[..], [Fault::Spike { samples: 3, height, .. }] if (height - 2000.0).abs() < 1.0)
    );
    // 37.8 N at sample 1224 of the third segment, to which the response answers.
    let [Fault::DoubleImpact { after_s, share }] = measured.impacts[2].faults[..] else {
        panic!("{}", text.all)
    };
    assert!((after_s - 0.02283).abs() < 1e-4 && (share - 0.204).abs() < 2e-3, "{after_s} {share}");
    assert_eq!(summary["impacts"][0]["faults"][0]["fault"], "spike");
    assert_eq!(summary["averages"], 3);
    assert!(
        text.all.contains(
            "impact 1   left out     172.2 N    0.27 ms  spike of 3 samples in Force (Trigger), up to 2000"
        ),
        "{}",
        text.all
    );

    // The written FRF is the one that was computed, with coherence and standard deviation.
    let frf = load_frf(&folder.path().join("frf.uff"), &Choice::default()).unwrap();
    let ours = &measured.frfs[0];
    assert_eq!((frf.quantity, frf.frequency_hz.len()), (Some(Quantity::Accelerance), 25599));
    for (there, here) in frf.response.iter().zip(&ours.response) {
        // 13 digits of each part.
        assert!((there - here).norm() <= 1e-12 * here.norm());
    }
    let std = frf.std.unwrap();
    for (k, variance) in ours.variance.as_ref().unwrap().iter().enumerate() {
        assert!((std[k].powi(2) - 2.0 * variance).abs() <= 1e-11 * variance);
    }
    assert_eq!(frf.coherence.unwrap().len(), 25599);
    for figure in ["force", "response", "spectra", "frf"] {
        assert_shows_something(&folder.path().join(format!("frf-figures/{figure}.png")));
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn a_table_has_the_same_frf_needs_data() {
    let file = shared("hammer/impact2_response0.lvm");
    let folder = tempfile::tempdir().unwrap();
    let measured = job(&file, &Options::default(), &folder.path().join("frf.csv")).measured;
    let frf = load_frf(&folder.path().join("frf.csv"), &Choice::default()).unwrap();
    assert_eq!(frf.response, measured.frfs[0].response);
    assert_eq!(frf.coherence, measured.frfs[0].coherence);
    assert!(frf.std.is_some());
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn a_decimal_comma_and_an_acceleration_in_g_needs_data() {
    let file = shared("hammer/acceleration.lvm");
    let folder = tempfile::tempdir().unwrap();
    let FrfJob { records, measured, .. } = job(&file, &Options::default(), &folder.path().join("frf.uff"));
    assert_eq!((records.force.name.as_str(), records.responses[0].scale), ("Force (Trigger)", 9.80665));
    assert_eq!((measured.impacts.len(), measured.averages()), (1, 1));
    // −0.007387 g is the first sample of the file.
    assert_eq!(records.recordings[0].responses[0][0], -0.007387 * 9.80665);
}

/// Takes these samples of these segments, and prints H₁, H₂ and coherence.
const SCRIPT: &str = "
import sys
import numpy as np, lvm_read, pyFRF
data = lvm_read.read(sys.argv[1], read_from_pickle=False, dump_file=False)
cut = lambda k, start, end: data[k]['data'][start:end]
records = np.array([cut(*(int(n) for n in word.split(','))) for word in sys.argv[2:]])
frf = pyFRF.FRF(round(1 / data[0]['Delta_X'][0]), exc=records[:, :, 0], resp=records[:, :, 1])
h1 = frf.get_FRF('H1', 'accelerance')[0, 0]
h2 = frf.get_FRF('H2', 'accelerance')[0, 0]
coherence = frf.get_coherence()[0]
for k in range(1, len(h1) - 1):
    print(*(float(x).hex() for x in (h1[k].real, h1[k].imag, h2[k].real, h2[k].imag, coherence[k])))
";

#[test]
#[ignore = "needs the data of ../shared/data and Python with pyFRF, lvm_read"]
fn pyfrf_estimates_the_same_needs_data_and_pyfrf_and_lvm_read() {
    let python = python_with("pyFRF, lvm_read");
    let file = shared("hammer/impact2_response0.lvm");
    let records = read_records(std::slice::from_ref(&file), &ChannelOptions::default()).unwrap();
    // The second contact of the third impact is 20 % of the first: with a limit above that four impacts are averaged.
    for (double_impact, averages) in [(0.1, 3), (0.25, 4)] {
        let options = Options::default().with_double_impact(double_impact);
        let estimate = |estimator| {
            estimate_frf(&records.recordings, &options.clone().with_estimator(estimator)).unwrap()
        };
        let (h1, h2) = (estimate(Estimator::H1), estimate(Estimator::H2));
        assert_eq!(h1.averages(), averages);
        let kept = h1.impacts.iter().filter(|impact| impact.is_kept());
        let cuts =
            kept.map(|impact| format!("{},{},{}", impact.recording, impact.range.start, impact.range.end));
        let output = Command::new(&python).args(["-c", SCRIPT]).arg(&file).args(cuts).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let theirs = String::from_utf8(output.stdout).unwrap();
        let rows: Vec<Vec<f64>> =
            theirs.lines().map(|line| line.split(' ').map(hexadecimal).collect()).collect();
        assert_eq!(rows.len(), h1.frequency_hz.len());
        let coherence = h1.frfs[0].coherence.as_ref().unwrap();
        for (k, row) in rows.iter().enumerate() {
            let f = h1.frequency_hz[k];
            for (ours, re, im) in
                [(h1.frfs[0].response[k], row[0], row[1]), (h2.frfs[0].response[k], row[2], row[3])]
            {
                let off = (ours - c64::new(re, im)).norm() / ours.norm();
                assert!(off < 1e-10, "{f} Hz: {ours} and {re} {im}");
            }
            assert!((coherence[k] - row[4]).abs() < 1e-10, "{f} Hz: {} and {}", coherence[k], row[4]);
        }
    }
}

/// `-0x1.8p+3` as Python writes it.
fn hexadecimal(text: &str) -> f64 {
    let (sign, digits) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let (mantissa, exponent) = digits.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let all = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    sign * all as f64 * 2f64.powi(exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32)
}

/// A UFF file in mm and N: two impacts of force and acceleration, a spectrum that is not meant.
#[test]
fn time_functions_of_a_uff_file_are_paired_in_their_order_and_scaled() {
    use frfit_formats::uff::{
        Axis, Dof, Form, Function, FunctionHeader, FunctionType, Quantity as Kind, Spacing, Units, Values,
        write,
    };
    let spacing = Spacing::Even { minimum: 0.0, increment: 1e-3 };
    let time = |quantity, unit: &str, node, values: Vec<f64>| {
        let header = FunctionHeader {
            function_type: FunctionType::TimeResponse,
            spacing,
            response: Dof { node, direction: 1, ..Dof::default() },
            abscissa: Axis { quantity: Kind::Time, unit: "s".into(), ..Axis::default() },
            ordinate: Axis { quantity, unit: unit.into(), ..Axis::default() },
            ..FunctionHeader::default()
        };
        let abscissa = (0..values.len()).map(|k| k as f64 * 1e-3).collect();
        write::function(&Function::new(header, abscissa, Values::Real(values)), Form::Ascii).unwrap()
    };
    // Half-sines of six samples on a mass of 2 kg: 0.5 m/s² a newton.
    let pulse = |peak: f64| -> Vec<f64> {
        let sine = |k: i32| (std::f64::consts::PI * (f64::from(k) + 0.4) / 5.77).sin();
        (0..200).map(|k| if (50..56).contains(&k) { peak * sine(k - 50) } else { 0.0 }).collect()
    };
    let scaled = |by: f64| move |x: f64| by * x;
    let units = Units { code: 9, length: 1000.0, force: 1.0, ..Units::default() };
    let mut bytes = write::units(&units).unwrap();
    for peak in [100.0, 70.0] {
        bytes.extend(time(Kind::ExcitationForce, "", 1, pulse(peak)));
        // Without a unit that is known by name, in the units of the file: mm/s². With one, in that.
        bytes.extend(time(Kind::Acceleration, "", 2, pulse(peak).into_iter().map(scaled(500.0)).collect()));
        bytes.extend(time(
            Kind::Acceleration,
            "g",
            3,
            pulse(peak).into_iter().map(scaled(0.5 / 9.80665)).collect(),
        ));
    }
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("impacts.uff"), folder.path().join("frf.uff"));
    std::fs::write(&file, bytes).unwrap();
    let FrfJob { records, measured, .. } = job(&file, &Options::default(), &out);
    assert_eq!((measured.impacts.len(), measured.averages(), records.responses.len()), (2, 2, 2));
    for frf in &measured.frfs {
        // The text of a function has 13 digits.
        assert!(frf.response.iter().all(|h| (h - c64::new(0.5, 0.0)).norm() < 1e-9));
    }
    for (record, node) in [(1, 2), (2, 3)] {
        let frf = load_frf(&out, &Choice { record: Some(record), ..Choice::default() }).unwrap();
        assert_eq!(frf.measured_at.unwrap().to_string(), format!("{node}+X"));
        assert_eq!(frf.driven_at.unwrap().to_string(), "1+X");
    }
    let table = frf_of_records(
        &[file],
        &ChannelOptions::default(),
        &Options::default(),
        &out.with_extension("csv"),
        None,
    );
    assert!(table.unwrap_err().to_string().contains("expected one response for a table"));
}

#[test]
fn a_channel_that_one_recording_lacks_is_named() {
    let impact = |channels: &str, rows: &str| {
        format!(
            "\nChannels\t{}\n***End_of_Header***\nX_Value\t{channels}\n{rows}",
            channels.split('\t').count()
        )
    };
    let rows = |width: usize| -> String {
        let value = |k: i32| if (50..56).contains(&k) { 100.0 - f64::from((k - 52).pow(2)) } else { 0.0 };
        (0..200)
            .map(|k| format!("{}{}\n", f64::from(k) * 1e-3, format!("\t{}", value(k)).repeat(width)))
            .collect()
    };
    let units = |text: String| {
        text.replace(
            "***End_of_Header***\nX_Value\tF\ta",
            "Y_Unit_Label\tN\tm/s^2\n***End_of_Header***\nX_Value\tF\ta",
        )
    };
    let text = format!(
        "LabVIEW Measurement\nX_Columns\tOne\n***End_of_Header***\n{}{}{}",
        units(impact("F\ta", &rows(2))),
        impact("F", &rows(1)),
        units(impact("F\ta", &rows(2))),
    );
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("impacts.lvm"), folder.path().join("frf.uff"));
    std::fs::write(&file, text).unwrap();
    let FrfJob { measured, text, .. } = job(&file, &Options::default(), &out);
    assert_eq!(measured.averages(), 2);
    assert!(
        text.all.contains("impact 2   left out") && text.all.contains("a is missing or does not move"),
        "{}",
        text.all
    );
}
