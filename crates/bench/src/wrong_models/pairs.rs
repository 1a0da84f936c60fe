//! Whether modes of two meshes are paired rightly by what a few sensors see of them.
//!
//! Which mode is which is known from the shapes at all nodes that both meshes have.

use super::Failure;
use super::dice::Dice;
use super::fault::Change;
use super::natural::{self, assurance, elastic, undamped};
use super::realised::{Realised, UNKNOWN};
use super::structure::{Kind, Structure};
use crate::tier::of_tier;
use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit::material::Law;
use frfit::modal::{PairedShape, paired};
use frfit::model::Role;
use frfit_linalg::sparse::Part;

/// Elements along x of a coarse mesh.
const COARSE: [usize; 2] = [6, 14];

/// Modes of a band.
const MODES: [usize; 2] = [4, 12];

/// Natural frequencies of the two meshes are so far apart at most.
const FARTHEST: f64 = 0.03;

/// Shapes at all nodes that are so much alike are of one mode.
const SAME: f64 = 0.9;

/// Residues below this part of the largest are not seen in a measurement: a sensor or the load is on a node of the mode.
const SEEN: f64 = 0.02;

/// Factor of the model's modulus over the true one.
const NOMINAL: [f64; 2] = [0.6, 1.4];

/// What came of a pair of meshes.
#[derive(Debug, Default)]
struct Counts {
    /// Modes that both meshes have.
    modes: usize,
    /// Those that are paired, and those of which another is the partner.
    right: usize,
    wrong: usize,
    /// Pairs of modes that have changed places.
    crossings: usize,
    /// Crossings that are missed, and other pairs that are called crossings.
    wrong_crossings: usize,
}

/// Modes of a mesh: natural frequency, shape at the stations, and what sensors see.
struct Seen {
    stations: Vec<f64>,
    shape: PairedShape,
}

fn seen(
    kind: Kind,
    mesh: &Realised,
    stations: &[[f64; 3]],
    rows: &[usize],
    count: usize,
) -> Result<Vec<Seen>, Failure> {
    let at = stations.iter().map(|&station| mesh.row(station)).collect::<Result<Vec<_>, _>>()?;
    let modes = undamped(&mesh.model, 1.0, count)?;
    let terms = mesh.model.terms();
    let energy = |shape: &[f64], wants: &dyn Fn(&str) -> bool| -> Result<f64, Failure> {
        let of = terms.iter().filter(|term| term.role == Role::Stiffness && wants(&term.name));
        let mut all = 0.0;
        for term in of {
            let mut force = vec![0.0; shape.len()];
            term.matrix.multiply_add_real(Part::Re, shape, &mut force);
            all += term.factor.at(1.0)?.re * force.iter().zip(shape).map(|(f, x)| f * x).sum::<f64>();
        }
        Ok(all)
    };
    // Of an orthotropic plate the unknown factor is one on all four constants.
    let all_unknown = kind == Kind::OrthotropicPlate;
    let one = |(hz, shape): (f64, &Vec<f64>)| {
        let residue = |&row: &usize| c64::new(0.0, -shape[rows[0]] * shape[row] / (2.0 * omega_rad_s(hz)));
        let share = energy(shape, &|name| all_unknown || name == UNKNOWN)? / energy(shape, &|_| true)?;
        Ok(Seen {
            stations: at.iter().map(|&row| shape[row]).collect(),
            shape: PairedShape {
                frequency_hz: hz,
                residues: rows[1..].iter().map(residue).collect(),
                energy_share: share,
            },
        })
    };
    elastic(&modes).map(one).collect()
}

/// Draws a structure with two meshes, and pairs their modes; `None` where the meshes are farther apart than they may be.
fn counted(seed: u64, index: u64) -> Result<Option<Counts>, Failure> {
    let mut dice = Dice::new(seed, index);
    let kind = dice.pick(&[Kind::Plate, Kind::Beam, Kind::Sandwich, Kind::OrthotropicPlate]);
    let mut structure = Structure::draw(kind, false, &mut dice);
    structure.set_mesh(dice.count(COARSE[0], COARSE[1]));
    let finer = Change { plan: dice.count(2, 3), layers: dice.count(1, 2), ..Change::default() };
    let true_modulus = Law::complex_modulus(structure.storage, 0.0);
    let model = Realised::new(
        &structure,
        &true_modulus.scaled(dice.between(NOMINAL[0], NOMINAL[1])),
        &Change::default(),
    )?;
    let truth = Realised::new(&structure, &true_modulus, &finer)?;
    let same = Realised::new(&structure, &true_modulus, &Change::default())?;
    let stations = model.stations();
    let points: Vec<[f64; 3]> = (0..dice.count(3, 6)).map(|_| dice.pick(&stations)).collect();
    let rows = |mesh: &Realised| points.iter().map(|&point| mesh.row(point)).collect::<Result<Vec<_>, _>>();
    let count = dice.count(MODES[0], MODES[1]);
    let Ok(own) = seen(kind, &model, &stations, &rows(&model)?, 2 * count + 6) else { return Ok(None) };
    let Ok(of_truth) = seen(kind, &truth, &stations, &rows(&truth)?, 2 * count + 6) else { return Ok(None) };
    let errors = natural::errors(
        &natural::modes(&same, &stations, 1.0, count + 6)?,
        &natural::modes(&truth, &stations, 1.0, 2 * count + 6)?,
    );
    if errors.len() < count || errors[..count].iter().any(|[_, error]| error.abs() > FARTHEST) {
        return Ok(None);
    }
    let size = |seen: &Seen| seen.shape.residues.iter().map(|r| r.norm_sqr()).sum::<f64>().sqrt();
    let largest = of_truth[..count].iter().map(size).fold(0.0, f64::max);
    let measured: Vec<&Seen> = of_truth[..count].iter().filter(|seen| size(seen) > SEEN * largest).collect();
    let shapes =
        |seen: &mut dyn Iterator<Item = &Seen>| seen.map(|one| one.shape.clone()).collect::<Vec<_>>();
    let pairing = paired(&shapes(&mut own.iter()), &shapes(&mut measured.iter().copied()));
    // Whose shape at all nodes is that of one mode of the model, and of no other.
    let partner = |mode: &Seen| {
        let alike = |i: &usize| assurance(&own[*i].stations, &mode.stations) > SAME;
        let mut same = (0..own.len()).filter(alike);
        same.next().filter(|_| same.next().is_none())
    };
    let known: Vec<(usize, usize)> =
        measured.iter().enumerate().filter_map(|(j, mode)| Some((partner(mode)?, j))).collect();
    let mut counts = Counts { modes: known.len(), ..Counts::default() };
    for &(i, j) in &known {
        let Some(pair) = pairing.pairs.iter().find(|pair| pair.measured == j) else { continue };
        if pair.model != i {
            counts.wrong += 1;
            continue;
        }
        counts.right += 1;
        // Among the pairs that are there.
        let is_crossing =
            pairing.pairs.iter().any(|one| one.model != i && (one.model < i) != (one.measured < j));
        counts.crossings += usize::from(is_crossing);
        counts.wrong_crossings += usize::from(is_crossing != pair.is_crossing);
    }
    Ok(Some(counts))
}

/// 2 to 5 sensors, meshes up to 3 % apart, a modulus up to 40 % off.
#[test]
fn modes_of_two_meshes_are_paired_rightly() {
    let asked = of_tier(6, 100);
    let all = (0..).filter_map(|index| counted(7, index).unwrap());
    let mut sum = Counts::default();
    for one in all.take(asked) {
        sum.modes += one.modes;
        sum.right += one.right;
        sum.wrong += one.wrong;
        sum.crossings += one.crossings;
        sum.wrong_crossings += one.wrong_crossings;
    }
    // Of a hundred: 653 modes, all of them, and 10 that have changed places.
    assert!(sum.modes > 5 * asked && sum.wrong == 0 && 100 * sum.right >= 99 * sum.modes, "{sum:?}");
    assert_eq!(sum.wrong_crossings, 0, "{sum:?}");
}
