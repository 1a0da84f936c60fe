//! Every key of a case file, once: the reader takes no other, and the reference is made of these.

use super::snippet::snippet;
use frfit::laws::{LawKind, Parameter, ParameterKind, UnknownLawKind};
use std::sync::LazyLock;

/// A kind of table, and the keys that it may have.
#[derive(Debug)]
pub(super) struct Section {
    /// Where it is: the keys that lead to it, `matrix.factor`; empty for the file itself.
    #[cfg_attr(not(test), expect(dead_code, reason = "tests look there for its keys"))]
    pub(super) path: &'static str,
    /// How it is written, for a heading.
    pub(super) title: &'static str,
    /// What it is for, as Markdown.
    pub(super) about: &'static str,
    /// Its keys, in the order in which an error lists them.
    pub(super) keys: &'static [Key],
    /// TOML in which each key stands at least once; what else a case needs is left out.
    pub(super) examples: &'static [&'static str],
}

/// A key of a table.
#[derive(Debug)]
pub(super) struct Key {
    pub(super) name: &'static str,
    /// What its value is. Words in double quotes are those that the reader knows, and all of them.
    pub(super) value: &'static str,
    /// What holds where the key is not there: [`NEEDED`], or the value that stands for it.
    pub(super) otherwise: &'static str,
    /// What it says, as Markdown.
    pub(super) about: &'static str,
}

/// A table without this key is refused.
pub(super) const NEEDED: &str = "needed";

const fn key(name: &'static str, value: &'static str, otherwise: &'static str, about: &'static str) -> Key {
    Key { name, value, otherwise, about }
}

/// All sections, in the order of the reference.
pub(super) static SECTIONS: LazyLock<Vec<&'static Section>> = LazyLock::new(|| {
    let before = [&CASE, &MATRIX, &MATRIX_FILE, &MATRIX_AT, &COMPLEX_MODULUS];
    let after = [
        &TABLE,
        &FACTOR_STD,
        &DOFS,
        &LOAD,
        &ATTACHED,
        &MEASUREMENT,
        &MODEL_ERROR,
        &COARSER_MESH,
        &UNKNOWN,
        &BOUNDS,
        &FOR_ALL,
        &SINGLE,
        &RESPOND,
    ];
    before.into_iter().chain(LAWS.iter().map(|(_, section)| section)).chain(after).collect()
});

/// The laws of a factor over frequency, each with its section, made of its parameters.
pub(super) static LAWS: LazyLock<Vec<(LawKind, Section)>> = LazyLock::new(|| {
    let laws = LawKind::FAMILIES.into_iter().filter(|kind| *kind != LawKind::Constant);
    laws.map(|kind| (kind, section_of(kind))).collect()
});

/// The words of these laws: `"fractional", "zener" or "maxwell"`.
pub(super) fn law_words() -> String {
    let words = LawKind::FAMILIES.into_iter().filter(|kind| *kind != LawKind::Constant);
    let words: Vec<String> = words.map(|kind| format!("{:?}", kind.word())).collect();
    let (last, others) = words.split_last().expect("there are laws");
    format!("{} or {last}", others.join(", "))
}

/// The section of a law. It is made once, for as long as the program runs.
fn section_of(kind: LawKind) -> Section {
    let of = |parameter: &Parameter| {
        let value = match parameter.kind {
            ParameterKind::Time => "number above 0, s",
            ParameterKind::Exponent => "number from 0 to 1",
            _ => "number",
        };
        key(parameter.name.clone().into_owned().leak(), value, NEEDED, parameter.about)
    };
    let mut keys = vec![key("law", law_words().leak(), NEEDED, "Which law.")];
    if let LawKind::Maxwell { .. } = kind {
        keys.extend(kind.parameters().iter().take(1).map(of));
        keys.push(key("branches", "list of [modulus, time in s]", NEEDED, "At least one; times above 0."));
    } else {
        keys.extend(kind.parameters().iter().map(of));
    }
    let p: Vec<f64> = kind.parameters().iter().map(|parameter| parameter.example).collect();
    let factor = snippet(&kind.law(&p));
    let example =
        format!("[[matrix]]\nname = \"rubber\"\nrole = \"stiffness\"\nfile = \"K.mtx\"\n{factor}\n");
    Section {
        path: "matrix.factor",
        title: format!("`factor = {{ law = {:?}, … }}`", kind.word()).leak(),
        about: kind.formula(),
        keys: keys.leak(),
        examples: vec![&*example.leak()].leak(),
    }
}

pub(super) static CASE: Section = Section {
    path: "",
    title: "The file",
    about: "TOML. Paths are relative to the case file. A key that is not on this page is an error that names the nearest known one.",
    keys: &[
        key("title", "text", "the name of the file", "Stands over figures and report."),
        key(
            "units",
            "\"m-kg-s\", \"SI\", \"mm-t-s\", \"mm-kg-ms\", \"mm-g-ms\", \"mm-kg-s\", \"m-t-s\", \"cm-g-s\", \"in-lbf-s\" or \"ft-lbf-s\"",
            "SI",
            "Units of the model: of matrices, factors, bounds, nominal values and what is attached; see [Units](units.md). \
             Measurements and loads are in SI units in each of them, frequencies in hertz, and times of laws in seconds.",
        ),
        key("matrix", "tables `[[matrix]]`, at least one", NEEDED, "The terms of the model."),
        key("dofs", "table `[dofs]`", "names of the matrices' files, else row numbers", "Names of the rows."),
        key(
            "attached",
            "tables `[[attached]]`",
            "none",
            "Masses, springs and dampers that are on the structure and not in the matrices.",
        ),
        key("load", "table `[load]`", NEEDED, "Where the force acts."),
        key(
            "measurement",
            "tables `[[measurement]]`, at least one",
            NEEDED,
            "What was measured, or where it is to be computed.",
        ),
        key(
            "model_error",
            "\"estimated\", \"none\", a number, a text as \"0.5 %\", or table `[model_error]`",
            "\"estimated\"",
            "Errors of the model's natural frequencies, mode shapes and known matrices: estimated from the band and taken out where they explain it better than a right model, or none, where error bars hold the noise alone, or as large as you know them to be, and in every error bar.",
        ),
        key(
            "coarser_mesh",
            "text, or table `[coarser_mesh]`",
            "one mesh",
            "The case file of the same structure on a coarser mesh: both together say how far the natural frequencies of this one are off.",
        ),
        key(
            "identify",
            "table `[identify]`, or tables `[[identify]]`",
            "nothing is identified",
            "What is unknown.",
        ),
        key(
            "respond",
            "table `[respond]`",
            "the measured frequencies",
            "Frequencies of `frfit respond` and `frfit sensitivities`; without `[identify]` the band of `frfit modes`.",
        ),
    ],
    examples: &["title = \"Bar\"
units = \"SI\"
model_error = \"0.5 %\"
coarser_mesh = \"coarse.toml\"
[[matrix]]
name = \"bar\"
role = \"stiffness\"
file = \"K.mtx\"
factor = { storage = 1.2e6, loss_factor = 0.1 }
[[matrix]]
name = \"mass\"
role = \"mass\"
file = \"M.mtx\"
factor = 910.0
[dofs]
file = \"dofs.csv\"
[[attached]]
dof = \"9+X\"
mass_kg = 0.004
[load]
dof = \"1+X\"
[[measurement]]
file = \"frf.uff\"
dof = \"9+X\"
[identify]
matrix = \"bar\"
band_hz = [20.0, 2000.0]
[respond]
band_hz = [1.0, 3000.0]
points = 600
"],
};

pub(super) static MATRIX: Section = Section {
    path: "matrix",
    title: "`[[matrix]]`",
    about: "One term of the model each: D(ω) = Σ factor·stiffness + iω Σ factor·viscous − ω² Σ factor·mass. All have the same number of rows, unless their files name their rows.",
    keys: &[
        key("name", "text", NEEDED, "By which `[identify]` and the results speak of it; each has its own."),
        key("role", "\"stiffness\", \"mass\" or \"viscous\"", NEEDED, "Where it stands in D(ω)."),
        key(
            "file",
            "text, or `{ file, name }`",
            "`at`",
            "The matrix: Matrix Market, Harwell–Boeing, CalculiX, Abaqus, Nastran DMIG or OUTPUT4, Ansys HBMAT, NumPy, MATLAB; recognised by the content. It has to be symmetric.",
        ),
        key(
            "at",
            "`{ dimension, values, files, powers }`",
            "`file`",
            "The same matrix at several values of a dimension.",
        ),
        key(
            "factor",
            "number, or a table as below",
            "1",
            "What the matrix is multiplied by. Of an unknown: its nominal value.",
        ),
        key(
            "factor_is",
            "\"modulus\" or \"relative\"",
            "`modulus` from 100 on, else `relative`",
            "Of a stiffness: a modulus, for a matrix that was made with modulus one, or a number relative to the modulus that the matrix was made with. \
             Results are labelled by it. Say it where `units` have moduli of such sizes, as 2 MPa of rubber.",
        ),
    ],
    examples: &["[[matrix]]
name = \"mass\"
role = \"mass\"
file = \"M.mtx\"
factor = 910.0                 # kg/m³, for a matrix made with density one
[[matrix]]
name = \"plate\"
role = \"stiffness\"
factor_is = \"relative\"
at = { dimension = \"thickness\", values = [0.0018, 0.002, 0.0022], files = [\"k18.mtx\", \"k20.mtx\", \"k22.mtx\"] }
"],
};

pub(super) static MATRIX_AT: Section = Section {
    path: "matrix.at",
    title: "`at = { … }` of a matrix that depends on a dimension",
    about: "The matrix is a sum of powers of the dimension. The sum goes through the matrices at all values but one, in the middle, and has to meet that one: then it is the matrix at every value. \
            `[[identify]]` with this name and a `nominal` value has the dimension as unknown; elsewhere it has that value. \
            Which powers solids, shells and beams need: [Several unknowns](several.md).",
    keys: &[
        key("dimension", "text", NEEDED, "Its name: that of an `[[identify]]`."),
        key(
            "values",
            "list of numbers",
            NEEDED,
            "One more than there are powers, each once: 5 without `powers` for a cube. With `powers` above 0; without, from 3 to 10 of them, other than 0.",
        ),
        key("files", "list of texts", NEEDED, "A file for each value, of one matrix each."),
        key(
            "powers",
            "list of whole numbers from −12 to 12",
            "0, 1, 2 and so on, one fewer than values",
            "The powers of the dimension that are in the matrix, each once.",
        ),
    ],
    examples: &["[[matrix]]
name = \"plate\"
role = \"stiffness\"
at = { dimension = \"thickness\", values = [0.0018, 0.002, 0.0022], files = [\"k18.mtx\", \"k20.mtx\", \"k22.mtx\"] }
", "[[matrix]]
name = \"block\"
role = \"stiffness\"
at = { dimension = \"height\", powers = [-1, 0, 1], values = [1.6, 1.8, 2.0, 2.2], files = [\"k16.mtx\", \"k18.mtx\", \"k20.mtx\", \"k22.mtx\"] }
"],
};

pub(super) static MATRIX_FILE: Section = Section {
    path: "matrix.file",
    title: "`file = { … }` of a file with several matrices",
    about: "`frfit inspect` lists the names.",
    keys: &[
        key("file", "text", NEEDED, "The file."),
        key("name", "text", "its only matrix", "Which of its matrices."),
    ],
    examples: &["[[matrix]]
name = \"plate\"
role = \"stiffness\"
file = { file = \"model.op4\", name = \"KAA\" }
"],
};

pub(super) static COMPLEX_MODULUS: Section = Section {
    path: "matrix.factor",
    title: "`factor = { storage, loss_factor }`",
    about: "A complex modulus E′(1 + iη), the same at all frequencies. This and the forms below hold for `factor` and for `reference`.",
    keys: &[
        key(
            "storage",
            "number",
            NEEDED,
            "E′, in the unit of the factor: that of a modulus in the case's `units` (Pa, MPa …) for a matrix made with modulus one.",
        ),
        key("loss_factor", "number", "0", "η."),
    ],
    examples: &["[[matrix]]
name = \"plate\"
role = \"stiffness\"
file = \"K.mtx\"
factor = { storage = 2.1e11, loss_factor = 0.001 }
"],
};

pub(super) static TABLE: Section = Section {
    path: "matrix.factor",
    title: "`factor = { table }`",
    about: "A modulus over frequency, interpolated over log ω; it has to reach every frequency that is asked for.",
    keys: &[key(
        "table",
        "text",
        NEEDED,
        "CSV with `frequency_hz`, `storage` and `loss_factor` (or `loss`).",
    )],
    examples: &["[[matrix]]
name = \"rubber\"
role = \"stiffness\"
file = \"K.mtx\"
factor = { table = \"modulus.csv\" }
"],
};

pub(super) static FACTOR_STD: Section = Section {
    path: "matrix.factor",
    title: "How well a factor is known",
    about: "Beside the keys of any of these forms. The error bars of all unknowns hold it, and the measurements may say better: then the error that they show is taken out.",
    keys: &[
        key(
            "storage_std",
            "number, or a text as \"2 %\"",
            "2 %, where the band shows errors of the model; else none",
            "Standard deviation of E′, or of a real factor: in its unit, or a part of it. A factor that varies has a part.",
        ),
        key(
            "loss_factor_std",
            "number, or a text as \"20 %\"",
            "0.002 and a tenth of η, where the band shows errors of the model; else none",
            "Standard deviation of η: a number, or a part of it.",
        ),
    ],
    examples: &["[[matrix]]
name = \"skins\"
role = \"stiffness\"
file = \"K_skins.mtx\"
factor = { storage = 7.0e10, loss_factor = 0.001, storage_std = \"2 %\", loss_factor_std = 0.0005 }
"],
};

pub(super) static DOFS: Section = Section {
    path: "dofs",
    title: "`[dofs]`",
    about: "Names of the rows, where the files of the matrices have none. A degree of freedom is then a node, a sign and a direction: `12+Z`, `7-RX`.",
    keys: &[key("file", "text", NEEDED, "CSV with `row` (from 1), `node`, `direction` (X Y Z RX RY RZ).")],
    examples: &["[dofs]
file = \"dofs.csv\"
"],
};

pub(super) static LOAD: Section = Section {
    path: "load",
    title: "`[load]`",
    about: "One of the three keys. An FRF is the response to a unit force at one degree of freedom; a file is for a force that is spread.",
    keys: &[
        key("dof", "name such as 12+Z", "`row` or `file`", "Unit force there; the sign is its sense."),
        key("row", "whole number", "`dof` or `file`", "Unit force on this row, from 1."),
        key(
            "file",
            "text",
            "`dof` or `row`",
            "CSV with `row` (from 1), `re`, `im`, in N (N·m in a row that is named as a rotation).",
        ),
    ],
    examples: &[
        "[load]
dof = \"12-Z\"
",
        "[load]
row = 301
",
        "[load]
file = \"force.csv\"
",
    ],
};

pub(super) static ATTACHED: Section = Section {
    path: "attached",
    title: "`[[attached]]`",
    about: "An accelerometer, the tip of a hammer, a suspension. `dof` or `row`, and at least one of `mass`, `mass_kg`, `stiffness` and `damping`. A number is in the `units` of the case, a text has units of its own. No rotary inertia.",
    keys: &[
        key(
            "dof",
            "name such as 12+Z",
            "`row`",
            "Where it is; a mass then moves in all translations of that node.",
        ),
        key("row", "whole number", "`dof`", "Where it is; a mass then moves in this row alone."),
        key("mass", "number above 0, or a text as `12 g`", "no mass", "A point mass."),
        key("mass_kg", "number above 0, kg", "no mass", "The same in kg, whatever the `units` are."),
        key(
            "directions",
            "list of X, Y, Z",
            "all translations of the node",
            "In which directions the mass moves; beside `dof`.",
        ),
        key(
            "stiffness",
            "number above 0, or a text as `3 N/mm`",
            "no spring",
            "A spring to ground: force over length, of a rotation moment over angle (`5 N m/rad`).",
        ),
        key(
            "damping",
            "number above 0, or a text as `0.2 N s/m`",
            "no damper",
            "A viscous damper to ground: force over velocity, of a rotation moment over angular velocity.",
        ),
    ],
    examples: &[
        "[[attached]]
dof = \"34+Z\"
mass_kg = 0.005
directions = [\"X\", \"Z\"]
",
        "[[attached]]
row = 3
mass = \"12 g\"
stiffness = 800.0
damping = 0.2
",
    ],
};

pub(super) static MEASUREMENT: Section = Section {
    path: "measurement",
    title: "`[[measurement]]`",
    about: "One FRF each. `frfit sensitivities` and `frfit respond` need only where the sensor is; without files `frfit modes` shows the model alone.",
    keys: &[
        key(
            "file",
            "text",
            "none, where nothing measured is needed",
            "UFF 58 or 58b, or CSV with `frequency_hz`, `re` and `im` (or `magnitude`, `magnitude_db` and `phase_deg`, `phase_rad`) and, if known, `coherence` or `std`.",
        ),
        key(
            "columns",
            "list of names",
            "as the first line of the table",
            "Columns of a CSV file whose names are others, or that has none; `-` for a column that is not read.",
        ),
        key(
            "dof",
            "name such as 12+Z",
            "`row`, or as the file says",
            "Where it was measured; the sign is its sense.",
        ),
        key("row", "whole number", "`dof`, or as the file says", "Where it was measured, from 1."),
        key("record", "whole number", "the one at this place", "Which FRF of a UFF file, from 1."),
        key(
            "quantity",
            "\"receptance\", \"mobility\" or \"accelerance\"",
            "as the file says",
            "Displacement, velocity or acceleration over force.",
        ),
        key(
            "averages",
            "whole number from 2",
            "the coherence weighs only",
            "Over how many records the coherence was averaged: with it the standard deviation follows.",
        ),
        key(
            "scale",
            "number other than 0, or \"unknown\"",
            "1",
            "What the values are to be multiplied by (9.81 for g). Unknown: it is found, beside a known channel, a law or a constant.",
        ),
        key(
            "delay_s",
            "number, s, or \"unknown\"",
            "0",
            "By how much this channel is late. Unknown: as with `scale`.",
        ),
        key(
            "decay_per_s",
            "number from 0, 1/s",
            "as the file says, or 0",
            "α = 1/τ of an exponential window e^(−αt) on force and response: the model is evaluated at ω − iα. The same for all measurements.",
        ),
    ],
    examples: &[
        "[[measurement]]
file = \"frf.uff\"
dof = \"34+Z\"
record = 2
quantity = \"accelerance\"
averages = 5
scale = 9.81
delay_s = 1e-5
decay_per_s = 6.0
",
        "[[measurement]]
file = \"frf.csv\"
columns = [\"frequency_hz\", \"magnitude_db\", \"phase_deg\", \"-\"]
row = 97
quantity = \"mobility\"
scale = \"unknown\"
delay_s = \"unknown\"
",
    ],
};

pub(super) static MODEL_ERROR: Section = Section {
    path: "model_error",
    title: "`[model_error]`",
    about: "How large the errors of the model are: relative standard deviations, as numbers or as texts such as \"0.5 %\". They are in every error bar, however well a right model explains the band. `model_error = \"0.5 %\"` is short for a table with `frequency` alone, `model_error = \"none\"` is for who knows that there are none. What is not said is estimated.",
    keys: &[
        key(
            "frequency",
            "number, or a text as \"0.5 %\"",
            "estimated",
            "Of natural frequencies, as of a mesh: at the upper end of the band.",
        ),
        key("shape", "number, or a text as \"3 %\"", "estimated", "Of mode shapes at the sensors."),
        key(
            "calibration",
            "number, or a text as \"1 %\"",
            "estimated",
            "Of the calibrations of the force and of each sensor.",
        ),
    ],
    examples: &["[model_error]
frequency = 0.005
shape = \"2 %\"
calibration = \"1 %\"
"],
};

pub(super) static COARSER_MESH: Section = Section {
    path: "coarser_mesh",
    title: "`[coarser_mesh]`",
    about: "The same structure on a coarser mesh, as a case file of its own: `coarser_mesh = \"coarse.toml\"` is short for a table with `file` alone. Its matrices, `[load]`, `[dofs]`, what is attached, and where it is measured are used, and its measurements are not; matrices and measurements have the order of this file. The modes of both meshes are paired, and what this mesh still has of their difference is taken out of the model and is in every error bar; see [Meshes](meshes.md).",
    keys: &[
        key("file", "text", NEEDED, "The case file."),
        key("element_ratio", "number above 1", "2", "Length of its elements over that of this mesh."),
        key(
            "order",
            "number above 0",
            "2",
            "Errors of natural frequencies go with this power of the length of elements: 2 of linear solids, shells and beams with shear, 4 of cubic beams and of quadratic solids.",
        ),
    ],
    examples: &["[coarser_mesh]
file = \"coarse.toml\"
element_ratio = 1.5
order = 2
"],
};

pub(super) static UNKNOWN: Section = Section {
    path: "identify",
    title: "`[identify]`, or `[[identify]]` for each of several unknowns",
    about: "The factor of a matrix, or a dimension; complex unless `real`. One table may be written either way.",
    keys: &[
        key(
            "name",
            "text",
            "names of the matrices",
            "Needed of a dimension: that of its `powers`, or of the matrices `at` its values.",
        ),
        key("matrix", "text or list of texts", "a dimension", "Whose factor is unknown; several share one."),
        key(
            "powers",
            "table of matrices and whole numbers from −12 to 12",
            "matrices `at` values of it",
            "A dimension: it multiplies the factor of each matrix to this power.",
        ),
        key(
            "varies",
            "\"frequency\", \"smooth\", \"constant\" or \"law\"",
            "frequency; of a dimension constant",
            "A value of its own at each frequency, a smooth curve (of a factor), one value for the band, or a law of few parameters.",
        ),
        key(
            "law",
            UnknownLawKind::EXPECTED,
            "all of them",
            "Beside `varies = \"law\"`: the law; of an only unknown also a list of laws, that are fitted and compared.",
        ),
        key("branches", "whole number from 1 to 20", "3", "Of `law = \"maxwell\"`."),
        key(
            "nominal",
            "number",
            "needed of a dimension, else the factor of the matrix",
            "A dimension's value to begin with: 1, or a length in the case's `units` where the matrices are made for a length of one.",
        ),
        key("bounds", "table, or [low, high] of a real one", "none", "What it can be."),
        key(
            "real",
            "true or false",
            "true of a dimension, else false",
            "A real unknown, as a density, a spring or a length.",
        ),
        key(
            "reference",
            "as `factor`",
            "none",
            "What a simulated measurement was made with. It is drawn, and used for nothing.",
        ),
    ],
    examples: &[
        "[identify]
matrix = [\"skins\", \"ribs\"]
band_hz = [20.0, 2000.0]
varies = \"law\"
law = [\"fractional\", \"maxwell\"]
branches = 3
bounds = { storage = [1e5, 1e9], loss_factor = [0.0, 3.0] }
reference = { storage = 1.2e6, loss_factor = 0.1 }
",
        "[[identify]]
name = \"core modulus\"
matrix = \"core\"
[[identify]]
name = \"thickness\"
powers = { bending = 3, membrane = 1, mass = 1 }
nominal = 1.0
bounds = [0.8, 1.25]
real = true
reference = 1.05
",
    ],
};

pub(super) static FOR_ALL: Section = Section {
    path: "identify",
    title: "Keys of the first `[[identify]]`, for all",
    about: "Where there are several unknowns, these keys are in the first table.",
    keys: &[
        key("band_hz", "[low, high], Hz", "`--band`", "Measured frequencies from low to high are used."),
        key(
            "exclude_hz",
            "list of frequencies and [low, high], Hz",
            "none",
            "Left out, as mains hum; their rows are `out_of_band`.",
        ),
        key(
            "max_lines",
            "whole number, 3 and more",
            "all",
            "Of more lines than this, those that show the unknowns best: half of them evenly spread, half where the measurement changes fastest. The others are `out_of_band`.",
        ),
        key(
            "reject_outliers",
            "true or false",
            "true",
            "Of three or more sensors one that contradicts all others is left out.",
        ),
        key(
            "check",
            "true or false",
            "true",
            "Look for what is wrong with the data, as `frfit check` does: first, or, unless a single unknown varies, where the band is not explained.",
        ),
    ],
    examples: &["[[identify]]
matrix = \"core\"
band_hz = [20.0, 1000.0]
exclude_hz = [[49.0, 51.0], 100.0]
max_lines = 500
reject_outliers = false
check = false
[[identify]]
matrix = \"skins\"
varies = \"constant\"
"],
};

pub(super) static SINGLE: Section = Section {
    path: "identify",
    title: "Keys of a single unknown that varies",
    about: "They are refused where there are several unknowns, or where the only one is constant or has a negative power: there is one way to find those. \
            Laws and smooth moduli need the default method.",
    keys: &[
        key(
            "method",
            "\"rational\", \"series\" or \"nelder-mead\"",
            "rational",
            "All solutions on a reduced model; the paper's Neumann series; a search to compare with.",
        ),
        key(
            "order",
            "whole number from 1 to 200",
            "30",
            "Series: terms. Rational: upper bound. Nelder–Mead: iterations.",
        ),
        key(
            "selection",
            "\"joint\" or \"smallest\"",
            "joint with rational, else smallest",
            "Who chooses among several solutions: all sensors and frequencies together, or the least correction (the paper).",
        ),
        key(
            "reduction",
            "\"auto\", \"full\" or \"subspace\"",
            "auto",
            "What answers at a frequency: the full model, or one reduced model for the band.",
        ),
        key(
            "start",
            "\"bounds\"",
            "the factor of the matrix",
            "There is no nominal value: it is looked for in all of the bounds, and `bounds.storage` is needed. Not of a dimension.",
        ),
    ],
    examples: &[
        "[identify]
matrix = \"plate\"
method = \"series\"
order = 30
selection = \"smallest\"
reduction = \"full\"
real = true
reference = 2700.0
",
        "[identify]
matrix = \"plate\"
bounds = { storage = [1e5, 1e9] }
start = \"bounds\"
",
    ],
};

pub(super) static BOUNDS: Section = Section {
    path: "identify.bounds",
    title: "`bounds = { … }`",
    about: "What is known beforehand: wide limits, in the unit of the factor, of the case's `units`. Low may be high where a single unknown varies, and is below it elsewhere.",
    keys: &[
        key(
            "storage",
            "[low, high]",
            "none",
            "Of E′, or of a real factor. Answers are looked for within a factor of four of the nominal first.",
        ),
        key("loss_factor", "[low, high]", "none", "Of η."),
    ],
    examples: &["[identify]
matrix = \"plate\"
bounds = { storage = [1e10, 1e12], loss_factor = [0.0, 0.5] }
"],
};

pub(super) static RESPOND: Section = Section {
    path: "respond",
    title: "`[respond]`",
    about: "Where `frfit respond` and `frfit sensitivities` compute; without `[identify]` the band of `frfit modes`.",
    keys: &[
        key("band_hz", "[low, high], Hz", NEEDED, "First and last frequency."),
        key(
            "points",
            "whole number from 1 to 1000000",
            NEEDED,
            "How many, equally spaced, both ends included.",
        ),
    ],
    examples: &["[respond]
band_hz = [10.0, 2000.0]
points = 400
"],
};
