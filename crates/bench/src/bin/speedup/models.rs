//! Models of one, two and three dimensions from a thousand to fifty thousand degrees of freedom.

use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor, Term};
use frfit_examples::{Error, Model, clamped_plate, rubber_bar, sandwich};
use frfit_fem::brick::{Face, Layer};
use frfit_fem::{Brick, Direction};

/// Models of one shape in ascending size.
pub(crate) struct Kind {
    pub(crate) name: &'static str,
    /// Those with up to this many degrees of freedom.
    pub(crate) models: fn(usize) -> Result<Vec<Model>, Error>,
}

/// From the least to the most coupled.
pub(crate) const KINDS: [Kind; 4] = [
    Kind {
        name: "bar",
        models: |limit| within(limit, [1000, 10_000, 50_000], |&n| n + 1, |&n| rubber_bar(n)),
    },
    Kind {
        name: "plate",
        models: |limit| within(limit, [20, 41, 59, 131], |&n| 3 * (n - 1) * (n - 1), |&n| clamped_plate(n)),
    },
    Kind {
        name: "sandwich",
        models: |limit| {
            let sizes = [[24, 2, 2], [48, 6, 2], [96, 12, 2], [160, 20, 2]];
            within(
                limit,
                sizes,
                |[nx, ny, core]| 3 * nx * (ny + 1) * (core + 3),
                |&[nx, ny, core]| sandwich(nx, ny, core),
            )
        },
    },
    Kind {
        name: "block",
        models: |limit| within(limit, [7, 12, 18], |&n| 3 * n * (n + 1) * (n + 1), |&n| block(n)),
    },
];

fn within<S, const COUNT: usize>(
    limit: usize,
    sizes: [S; COUNT],
    dofs: impl Fn(&S) -> usize,
    model: impl Fn(&S) -> Result<Model, Error>,
) -> Result<Vec<Model>, Error> {
    sizes.iter().filter(|size| dofs(size) <= limit).map(model).collect()
}

/// A steel cube of n × n × n bricks, clamped at one face: the densest factor that bricks make.
fn block(n: usize) -> Result<Model, Error> {
    let layers = vec![Layer { elements: n, ..Layer::default() }];
    let cube =
        Brick { elements: [n; 2], layers, clamped: vec![Face::XMin], ..Brick::default() }.assemble()?;
    let truth = Law::complex_modulus(2e11, 0.01);
    let term = |name: &str, role, matrix: &_, factor| Term {
        name: name.to_owned(),
        role,
        matrix: Clone::clone(matrix),
        factor,
    };
    let stiffness = DynamicStiffness::new(vec![
        term("steel", Role::Stiffness, &cube.stiffness[0], Law::complex_modulus(2.2e11, 0.01)),
        term("mass", Role::Mass, &cube.mass[0], Law::complex_modulus(7800.0, 0.0)),
    ])?;
    let row = cube.rows(Direction::Z).last().unwrap_or(0);
    let tip = Sensor { row, sign: 1.0 };
    Ok(Model {
        parameter: Parameter::factor_of(&stiffness, &["steel"])?,
        experiment: Experiment::driven_at(stiffness.dim(), tip, vec![tip]),
        stiffness,
        truth,
        band_hz: [20.0, 1000.0],
        step_hz: 10.0,
        dofs: Vec::new(),
    })
}
