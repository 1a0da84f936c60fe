//! Channels with a scale or a delay, known or to be found.

use super::planted::{TRUTH, folder, receptance, refusal, run, table, turned, worst};
use crate::noise::Noise;
use crate::tier::of_tier;
use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::identify::Status;

/// Two channels with gains (file over truth), and a share of noise that the file gives.
fn tables(gains: [f64; 2], delay_s: f64, noise: Option<(f64, &mut Noise)>) -> [String; 2] {
    let frequency_hz = linear_hz(12.0, 112.0, 81);
    let exact = receptance(&[], &[5, 7], &frequency_hz);
    let late = |f: f64, m: usize| if m == 0 { turned(f, -delay_s) } else { c64::new(1.0, 0.0) };
    let clean = |m: usize| -> Vec<c64> {
        frequency_hz.iter().zip(&exact).map(|(&f, x)| gains[m] * late(f, m) * x[m]).collect()
    };
    let Some((share, noise)) = noise else { return [0, 1].map(|m| table(&frequency_hz, &clean(m), None)) };
    [0, 1].map(|m| {
        let noisy = clean(m).into_iter().map(|u| u + share * u.norm() / 2f64.sqrt() * noise.complex());
        table(&frequency_hz, &noisy.collect::<Vec<_>>(), Some(share))
    })
}

fn keys(first: &str, second: &str, identify: &str) -> String {
    format!(
        "[[measurement]]\nfile = \"0.csv\"\nrow = 6\nquantity = \"receptance\"\n{first}\n\
         [[measurement]]\nfile = \"1.csv\"\nrow = 8\nquantity = \"receptance\"\n{second}\n\
         [identify]\nmatrix = \"springs\"\nband_hz = [12.0, 112.0]\n\
         bounds = {{ storage = [1e4, 1e7], loss_factor = [0.0, 1.0] }}\n{identify}\n"
    )
}

const LAW: &str = "varies = \"law\"\nlaw = \"constant\"";

#[test]
fn known_scales_and_delays_are_taken_out() {
    let tables = tables([1.0 / 9.81, -2.0], 3e-4, None);
    let job = run(&folder(&tables, &keys("scale = 9.81\ndelay_s = 3e-4", "scale = -0.5", ""))).unwrap();
    assert_eq!(worst(&job).1, 81);
    // Exact data, and answers that are asked to 1e-6.
    assert!(worst(&job).0 < 1e-6, "{:?}", worst(&job));
}

#[test]
fn an_unknown_scale_is_found_beside_a_known_one() {
    let exact =
        run(&folder(&tables([1.0, -1.0 / 0.37], 0.0, None), &keys("", "scale = \"unknown\"", ""))).unwrap();
    let scale = exact.summary["sensors"][1]["scale"].as_f64().unwrap();
    assert!((scale + 0.37).abs() < 1e-8 && worst(&exact).0 < 1e-6, "{scale} {:?}", worst(&exact));
    assert!(exact.summary["sensors"][0].get("scale").is_none());

    let (mut noise, mut pulls, mut covered) = (Noise::new(3), Vec::new(), Vec::new());
    let draws = of_tier(1, 6);
    for _ in 0..draws {
        let tables = tables([1.0, -1.0 / 0.37], 0.0, Some((0.02, &mut noise)));
        let job = run(&folder(&tables, &keys("", "scale = \"unknown\"", ""))).unwrap();
        let sensor = &job.summary["sensors"][1];
        let [value, std] = ["scale", "scale_std"].map(|key| sensor[key].as_f64().unwrap());
        assert!(std < 0.02 * 0.37, "{sensor}");
        pulls.push((value + 0.37) / std);
        let ok = job.run.found.lines.iter().filter(|o| o.status == Status::Ok);
        covered.extend(
            ok.filter_map(|o| Some((o.storage()? - TRUTH.re).abs() <= 2.0 * o.uncertainty()?.storage_std)),
        );
    }
    // All of six within 4 standard deviations but for one in 2600; their mean square is 1 ± 0.6.
    let mean_square = pulls.iter().map(|pull| pull * pull).sum::<f64>() / draws as f64;
    assert!(pulls.iter().all(|pull| pull.abs() < 4.0) && mean_square < of_tier(16.0, 3.5), "{pulls:?}");
    // Of some hundred answers 95 % of normal errors; those of one seed share the scale's.
    let share = covered.iter().filter(|&&within| within).count() as f64 / covered.len() as f64;
    assert!(covered.len() > of_tier(16, 100) && share > of_tier(0.6, 0.85), "{share} of {}", covered.len());
}

#[test]
fn a_law_needs_no_channel_of_known_scale() {
    let (mut noise, mut pulls) = (Noise::new(8), Vec::new());
    for _ in 0..of_tier(1, 5) {
        let tables = tables([-0.4, 1.0 / 0.37], 0.0, Some((0.02, &mut noise)));
        let job = run(&folder(&tables, &keys("scale = \"unknown\"", "scale = \"unknown\"", LAW))).unwrap();
        for (m, truth) in [(0, -2.5), (1, 0.37)] {
            let sensor = &job.summary["sensors"][m];
            let [value, std] = ["scale", "scale_std"].map(|key| sensor[key].as_f64().unwrap());
            pulls.push((value - truth) / std);
        }
        let parameter = |name: &str| {
            let sensor = &job.summary["laws"]["laws"][0]["parameters"][name];
            ["value", "std"].map(|key| sensor[key].as_f64().unwrap())
        };
        let [[storage, storage_std], [eta, eta_std]] = [parameter("storage"), parameter("loss_factor")];
        pulls.push((storage - TRUTH.re) / storage_std);
        pulls.push((eta - TRUTH.im / TRUTH.re) / eta_std);
        assert_eq!(job.run.count(Status::Ok), 81);
    }
    // Twenty within 4 standard deviations but for one in 800.
    let mean_square = pulls.iter().map(|pull| pull * pull).sum::<f64>() / pulls.len() as f64;
    assert!(
        pulls.iter().all(|pull| pull.abs() < 4.0) && of_tier(0.0..4.0, 0.2..2.5).contains(&mean_square),
        "{pulls:?}"
    );
}

#[test]
fn an_unknown_delay_is_found_beside_an_unknown_scale() {
    // More than two periods at the top of the band, on a channel whose sense is reversed too.
    let (late, mut noise) = (-19e-3, Noise::new(4));
    let both = "scale = \"unknown\"\ndelay_s = \"unknown\"";
    let job = run(&folder(&tables([-1.0 / 0.37, 1.0], late, Some((0.02, &mut noise))), &keys(both, "", "")))
        .unwrap();
    let sensor = &job.summary["sensors"][0];
    let number = |key: &str| sensor[key].as_f64().unwrap();
    // A hundredth of a radian at the top of the band, from eighty values of two per cent.
    assert!(number("delay_s_std") < 1.5e-5, "{sensor}");
    assert!((number("delay_s") - late).abs() < 4.0 * number("delay_s_std"), "{sensor}");
    assert!((number("scale") + 0.37).abs() < 4.0 * number("scale_std"), "{sensor}");
    assert!(job.summary["sensors"][1].get("delay_s").is_none());
    // The response that is written is that of no delay.
    let exact = receptance(&[], &[5], &[12.0])[0][0];
    let measured = job.run.measured(12.0, &job.identify().unwrap().measured[0])[0];
    assert!((measured - exact).norm() < 0.1 * exact.norm(), "{measured} {exact}");
    // What is looked for is no finding.
    let findings = job.diagnosis.as_ref().map_or(&[][..], |diagnosis| &diagnosis.findings);
    assert!(findings.iter().all(|finding| finding.sensors != [0]), "{findings:?}");
}

/// Springs and mass, both constant, beside one calibrated channel; without one nothing says how large the response is.
#[test]
fn scales_and_delays_are_found_beside_several_unknowns() {
    let several = "[[identify]]\nmatrix = \"springs\"\nvaries = \"constant\"\nband_hz = [12.0, 112.0]\n\
                   bounds = { storage = [1e5, 5e5], loss_factor = [0.0, 0.5] }\n\
                   [[identify]]\nmatrix = \"mass\"\nvaries = \"constant\"\nreal = true\nbounds = [0.7, 1.4]\n";
    let keys = |first: &str, second: &str| {
        let single = keys(first, second, "");
        let (measurements, _) = single.split_once("[identify]").unwrap();
        format!("{measurements}{several}")
    };
    let both = "scale = \"unknown\"\ndelay_s = \"unknown\"";
    let values = tables([-1.0 / 0.37, 1.0], -19e-3, None);
    let job = run(&folder(&values, &keys(both, ""))).unwrap();
    let sensor = &job.summary["sensors"][0];
    let [scale, late] = ["scale", "delay_s"].map(|key| sensor[key].as_f64().unwrap());
    // Exact data.
    assert!((scale + 0.37).abs() < 1e-6 && (late + 19e-3).abs() < 1e-8, "{sensor}");
    let [springs, mass] = [0, 1].map(|j| job.run.found.constants[j].law.at(50.0).unwrap());
    assert!(
        (springs - TRUTH).norm() < 1e-5 * TRUTH.norm() && (mass.re - 1.0).abs() < 1e-5,
        "{springs} {mass}"
    );
    let names = job.summary["coordinates"].as_array().unwrap();
    assert!(names.iter().any(|name| name == "scale of measurement 1"), "{names:?}");

    let refused = refusal(&folder(&values, &keys(both, both)));
    assert!(refused.contains("the unknowns scale the whole model"), "{refused}");
}

#[test]
fn what_cannot_be_found_is_refused() {
    let unknown = "scale = \"unknown\"";
    for (first, second, identify, message) in [
        (
            unknown,
            unknown,
            "",
            "measurement.scale: expected a number here, another [[measurement]] whose scale and delay are known, or varies = \"law\" (a factor of its own at each frequency explains one sensor whatever its scale and delay), found \"unknown\" for all sensors",
        ),
        (
            unknown,
            "",
            "selection = \"smallest\"",
            "measurement.scale: expected a number, or selection = \"joint\", found \"unknown\" with selection \"smallest\"",
        ),
        (
            unknown,
            "",
            "reduction = \"full\"",
            "measurement.scale: expected a number, or the reduction \"subspace\", found \"unknown\" with reduction \"full\"",
        ),
        (
            "scale = 0",
            "",
            "",
            "measurement.scale: expected a finite number other than 0, or \"unknown\", found 0",
        ),
        (
            "scale = \"some\"",
            "",
            "",
            "measurement.scale: expected a finite number other than 0, or \"unknown\", found the text \"some\"",
        ),
        (
            "delay_s = \"unknown\"",
            "delay_s = \"unknown\"",
            "",
            "measurement.delay_s: expected a number here, another [[measurement]] whose scale and delay are known, or varies = \"law\" (a factor of its own at each frequency explains one sensor whatever its scale and delay), found \"unknown\" for all sensors",
        ),
        (
            "delay_s = \"unknown\"",
            "",
            "selection = \"smallest\"",
            "measurement.delay_s: expected a number, or selection = \"joint\", found \"unknown\" with selection \"smallest\"",
        ),
        (
            "delay_s = \"soon\"",
            "",
            "",
            "measurement.delay_s: expected a finite number of seconds, or \"unknown\", found the text \"soon\"",
        ),
    ] {
        let said = refusal(&folder(&tables([1.0, 1.0], 0.0, None), &keys(first, second, identify)));
        assert!(said.ends_with(message), "{said}");
    }
}
