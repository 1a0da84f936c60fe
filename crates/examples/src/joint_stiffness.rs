//! Two beams, and between them a joint of unknown stiffness and damping: a matrix of rank one.

use crate::model::{names, nearest, real, term};
use crate::{Error, SeveralModel};
use frfit::identify::{Dependence, Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role};
use frfit::roots::Bounds;
use frfit_fem::{Assembled, Beam, Direction, Dof, Support};
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};

/// Lengths in m: of the beam that is clamped, and of the one that hangs on it.
const LENGTHS: [f64; 2] = [0.40, 0.30];

/// Width and height in m of both.
const WIDTH: f64 = 0.03;
const HEIGHT: f64 = 0.008;

/// Storage modulus (Pa), loss factor and density (kg/m³) of steel, known.
const STORAGE: f64 = 2.1e11;
const LOSS_FACTOR: f64 = 0.001;
const DENSITY: f64 = 7850.0;

/// Rotational stiffness in N·m/rad and its loss factor: as designed, and as it is.
const DESIGNED: [f64; 2] = [5000.0, 0.01];
const REAL: [f64; 2] = [1800.0, 0.04];

/// A cantilever of two beams in line, `elements` each, which move together where they meet and turn independently: a spring holds the angle between them.
///
/// Struck a little before the joint, measured at the tip and in the middle of the first beam, with 2 % noise. 10 Hz to 1000 Hz.
/// Rows: 4 elements + 1.
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn joint_stiffness(elements: usize) -> Result<SeveralModel, Error> {
    let (beams, joint) = joined(elements)?;
    let at = |x: f64| nearest(&beams, [x, 0.0, 0.0], Direction::Z);
    let [designed, truth] = [DESIGNED, REAL].map(|[k, loss_factor]| Law::complex_modulus(k, loss_factor));
    let stiffness = DynamicStiffness::new(vec![
        term("beams", Role::Stiffness, &beams.stiffness[0], Law::complex_modulus(STORAGE, LOSS_FACTOR)),
        term("joint", Role::Stiffness, &joint, designed.clone()),
        term("mass", Role::Mass, &beams.mass[0], real(DENSITY)),
    ])?;
    let joint = Unknown {
        name: "joint".into(),
        dependence: Dependence::Factor(vec![1]),
        nominal: designed,
        varies: Variation::Constant,
        real: false,
        bounds: Bounds { storage: Some([100.0, 1e5]), loss_factor: Some([0.0, 0.5]) },
    };
    let sensors = [LENGTHS[0] + LENGTHS[1], 0.5 * LENGTHS[0]].map(at).to_vec();
    Ok(SeveralModel {
        stiffness,
        experiment: Experiment::driven_at(beams.dofs.len(), at(0.8 * LENGTHS[0]), sensors),
        unknowns: vec![joint],
        truth: vec![truth],
        noise: 0.02,
        band_hz: [10.0, 1000.0],
        step_hz: 5.0,
        dofs: names(&beams),
    })
}

/// Both beams, and (θ_b − θ_a)² of the angles at the joint as a matrix.
fn joined(elements: usize) -> Result<(Assembled, SymmetricMatrix), Error> {
    let beam = |length: f64, ends: [Support; 2]| {
        let (area, inertia) = (WIDTH * HEIGHT, WIDTH * HEIGHT.powi(3) / 12.0);
        Beam { length, area, inertia, elements, ends, ..Beam::default() }.assemble()
    };
    let first = beam(LENGTHS[0], [Support::Clamped, Support::Free])?;
    let second = beam(LENGTHS[1], [Support::Free, Support::Free])?;
    let count = first.dofs.len();
    // A beam's rows are Z, RY of one node after the other: Z of the second's first node is that of the first's last.
    let [shared, angle] = [count - 2, count - 1];
    let rows: Vec<usize> =
        (0..second.dofs.len()).map(|row| if row == 0 { shared } else { count - 1 + row }).collect();
    let own: Vec<usize> = (0..count).collect();
    let dim = count + second.dofs.len() - 1;
    let both = |a: &SymmetricMatrix, b: &SymmetricMatrix| {
        let mut sum = Triplets::new(dim);
        for (matrix, rows) in [(a, &own), (b, &rows)] {
            // The elements are real: nothing is lost here.
            for ((row, col), value) in
                matrix.pattern().positions().zip(matrix.real_values().unwrap_or_default())
            {
                sum.add(rows[row], rows[col], *value);
            }
        }
        sum.assemble()
    };
    let mut joint = Triplets::new(dim);
    joint.add_element(&[Some(angle), Some(rows[1])], &[1.0, -1.0, -1.0, 1.0]);
    let labels = first.nodes.len();
    let dofs = second.dofs[1..].iter().map(|dof| Dof { node: dof.node + labels, ..*dof });
    let nodes = second.nodes.iter().map(|[x, y, z]| [x + LENGTHS[0], *y, *z]);
    let beams = Assembled {
        stiffness: vec![both(&first.stiffness[0], &second.stiffness[0])],
        mass: vec![both(&first.mass[0], &second.mass[0])],
        dofs: first.dofs.iter().copied().chain(dofs).collect(),
        nodes: first.nodes.iter().copied().chain(nodes).collect(),
    };
    Ok((beams, joint.assemble()))
}
