//! The hammer test of the wooden plate: its records against direct solves of the finer mesh.

use frfit::quantity::Quantity;
use frfit::signal::{Options, Recording, estimate_frf};
use frfit_examples::{orthotropic_plate, plate_records};
use frfit_formats::lvm;

const GRAVITY: f64 = 9.80665;

fn recordings(impacts: usize, noise: f64) -> Vec<Recording> {
    let file = lvm::read(&plate_records(impacts, noise).unwrap()).unwrap();
    let recording = |segment: &lvm::Segment| {
        let units = segment.channels.iter().map(|channel| channel.unit.as_str());
        assert_eq!(units.collect::<Vec<_>>(), ["N", "g"]);
        let force = segment.channels[0].values.clone();
        let acceleration = segment.channels[1].values.iter().map(|g| GRAVITY * g).collect();
        Recording { step_s: 1.0 / 1280.0, force, responses: vec![acceleration] }
    };
    file.segments.iter().map(recording).collect()
}

#[test]
fn records_have_the_frf_of_the_finer_mesh_as_the_response_has_decayed() {
    let measured = estimate_frf(&recordings(1, 0.0), &Options::default()).unwrap();
    assert_eq!((measured.samples, measured.frequency_hz[0]), (4096, 0.3125));
    // What is left at the end of the record: e⁻⁶ of the lowest bending mode, whose damping is 0.5 %.
    assert!((1e-5..2e-3).contains(&measured.impacts[0].residual[0]), "{:?}", measured.impacts[0].residual);
    // Lines at and between resonances, some 30 Hz apart.
    let lines: Vec<usize> = (100..1440).step_by(95).collect();
    let frequency_hz: Vec<f64> = lines.iter().map(|&k| measured.frequency_hz[k]).collect();
    let exact = orthotropic_plate([20, 10]).unwrap().exact(&frequency_hz).unwrap();
    let exact: Vec<_> = (frequency_hz.iter().zip(&exact))
        .map(|(f, x)| Quantity::Accelerance.from_receptance(*f, x[0]))
        .collect();
    let largest = exact.iter().map(|h| h.norm()).fold(0.0, f64::max);
    for ((f, k), exact) in frequency_hz.iter().zip(lines).zip(exact) {
        let off = (measured.frfs[0].response[k] - exact).norm();
        // Six decimals of a force whose spectrum is that of one sample, and what the end of the record cuts off.
        assert!(off < 2e-3 * largest, "{f} Hz: {:e}", off / largest);
    }
}

/// The number of elements does not change where the plate is struck and measured.
#[test]
fn models_scale() {
    for elements in [[3, 3], [8, 4], [20, 10]] {
        let model = orthotropic_plate(elements).unwrap();
        assert_eq!(model.stiffness.dim(), 4 * (elements[0] + 1) * (elements[1] + 1));
        let rig = model.rig();
        let nodes = [rig.driven_at().unwrap(), rig.measured_dof(0)].map(|name| name.node as usize - 1);
        let places = nodes.map(|node| [node % (elements[0] + 1), node / (elements[0] + 1)]);
        assert_eq!(places, [[1, 1], elements.map(|count| count - 1)]);
        let unnamed = model.dofs.iter().filter(|name| name.is_none()).count();
        assert_eq!(4 * unnamed, model.dofs.len());
    }
    for broken in [[2, 4], [0, 0], [usize::MAX, 4]] {
        assert!(orthotropic_plate(broken).is_err());
    }
}
