//! Every key of a case file, once: the reader takes no other, and the reference is made of these.

use super::snippet::snippet;
use frfit::laws::{LawKind, Parameter, ParameterKind, UnknownLawKind};
use std::sync::LazyLock;

/// A kind of table, and the keys that it may have.
#[derive(Debug)]
pub(super) struct Section {
    /// Where it is: the keys that lead to it, `matrix.factor`; empty for the file itself.
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
    /// The default: [`NEEDED`], or the value that frfit uses without the key.
    pub(super) otherwise: &'static str,
    /// Its description, as Markdown.
    pub(super) about: &'static str,
}

/// A table without this key is refused.
pub(super) const NEEDED: &str = "required";

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
        &SOLVER,
    ];
    before.into_iter().chain(LAWS.iter().map(|(_, section)| section)).chain(after).collect()
});

/// The kinds of laws that have a section.
fn law_kinds() -> impl Iterator<Item = LawKind> {
    LawKind::families().filter(|kind| *kind != LawKind::Constant)
}

/// The laws of a factor over frequency, each with its section, made of its parameters.
pub(super) static LAWS: LazyLock<Vec<(LawKind, Section)>> =
    LazyLock::new(|| law_kinds().map(|kind| (kind, section_of(kind))).collect());

/// The words of these laws: `"fractional", "zener" or "maxwell"`.
pub(super) fn law_words() -> String {
    let words: Vec<String> = law_kinds().map(|kind| format!("{:?}", kind.word())).collect();
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
    let mut keys = vec![key("law", law_words().leak(), NEEDED, "The law.")];
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
    about: "The case file is TOML.\nPaths are relative to the case file.\nA key that is not on this page is an error, and the message names the nearest known key.",
    keys: &[
        key("title", "text", "the name of the file", "Title of the figures and the report."),
        key(
            "units",
            "\"m-kg-s\", \"SI\", \"mm-t-s\", \"mm-kg-ms\", \"mm-g-ms\", \"mm-kg-s\", \"m-t-s\", \"cm-g-s\", \"in-lbf-s\" or \"ft-lbf-s\"",
            "SI",
            "Units of the model, for matrices, factors, bounds, nominal values and `[[attached]]`; see [Units](units.md). \
             Measurements and loads are always in SI units, frequencies in hertz, and times of laws in seconds.",
        ),
        key("matrix", "tables `[[matrix]]`, at least one", NEEDED, "The terms of the model."),
        key("dofs", "table `[dofs]`", "names in the matrix files, else row numbers", "Names of the rows."),
        key(
            "attached",
            "tables `[[attached]]`",
            "none",
            "Masses, springs and dampers on the structure that the matrices do not contain.",
        ),
        key("load", "table `[load]`", NEEDED, "Where the force acts."),
        key(
            "measurement",
            "tables `[[measurement]]`, at least one",
            NEEDED,
            "The measured FRFs, or the DOFs where frfit computes them.",
        ),
        key(
            "model_error",
            "\"estimated\", \"none\", a number, a text such as \"0.5 %\", or table `[model_error]`",
            "\"estimated\"",
            "Errors of the model: of its natural frequencies, mode shapes and known matrices. \
             \"estimated\": frfit estimates them from the band and corrects the model if they explain it better than a correct model. \
             \"none\": error bars contain the noise, and `storage_std` and `loss_factor_std` where given. \
             A size: the errors are as large as you state, and in every error bar.",
        ),
        key(
            "coarser_mesh",
            "text, or table `[coarser_mesh]`",
            "one mesh",
            "The case file of the same structure on a coarser mesh. Both together show the errors of the natural frequencies of this one.",
        ),
        key(
            "identify",
            "table `[identify]`, or tables `[[identify]]`",
            "nothing is identified",
            "The unknowns.",
        ),
        key(
            "respond",
            "table `[respond]`",
            "the measured frequencies",
            "Frequencies for `frfit respond` and `frfit sensitivities`; without `[identify]` also the band for `frfit modes`.",
        ),
        key(
            "solver",
            "table `[solver]`",
            "frfit's own solver",
            "What factorises the matrices of a large model.",
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
[solver]
engine = \"mumps\"
"],
};

pub(super) static MATRIX: Section = Section {
    path: "matrix",
    title: "`[[matrix]]`",
    about: "Each table is one term of the model:\nD(ω) = Σ factor·stiffness + iω Σ factor·viscous − ω² Σ factor·mass.\nAll matrices have the same number of rows, unless their files name their rows.",
    keys: &[
        key("name", "text", NEEDED, "Name in `[identify]` and in the results; unique."),
        key("role", "\"stiffness\", \"mass\" or \"viscous\"", NEEDED, "Its place in D(ω)."),
        key(
            "file",
            "text, or `{ file, name }`",
            "`at`",
            "File of the matrix: Matrix Market, Harwell–Boeing, CalculiX, Abaqus, Nastran DMIG or OUTPUT4, Ansys HBMAT, NumPy, MATLAB. frfit recognises the format by the content. The matrix must be symmetric.",
        ),
        key(
            "at",
            "`{ dimension, values, files, powers }`",
            "`file`",
            "The matrix at several values of a dimension, in place of `file`.",
        ),
        key(
            "factor",
            "number, or a table as below",
            "1",
            "Factor of the matrix; for an unknown, its nominal value.",
        ),
        key(
            "factor_is",
            "\"modulus\" or \"relative\"",
            "`modulus` from 100 on, else `relative`",
            "Meaning of a stiffness factor: a modulus, for a matrix assembled with a modulus of one, or a number relative to the modulus that the matrix was assembled with. \
             It sets the labels of the results. State it if moduli in your `units` are below 100, such as 2 MPa for rubber.",
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
at = { dimension = \"thickness\", values = [0.0018, 0.0019, 0.002, 0.0021, 0.0022], files = [\"k18.mtx\", \"k19.mtx\", \"k20.mtx\", \"k21.mtx\", \"k22.mtx\"] }
"],
};

pub(super) static MATRIX_AT: Section = Section {
    path: "matrix.at",
    title: "`at = { … }` of a matrix that depends on a dimension",
    about: "The matrix is a sum of powers of the dimension.\nfrfit fits the sum through the matrices at all values but the middle one.\nThe sum must match the middle one as a check.\n\
            `[[identify]]` with this name and a `nominal` value makes the dimension an unknown.\nOther commands use the nominal value.\n\
            [Several unknowns](several.md) lists the powers for solids, shells and beams.",
    keys: &[
        key("dimension", "text", NEEDED, "Its name, the `name` of an `[[identify]]`."),
        key(
            "values",
            "list of numbers",
            NEEDED,
            "Values of the dimension, all different, one more than there are powers: 5 without `powers` for a cube. With `powers` they must be above 0. Without, give 3 to 10 values other than 0.",
        ),
        key("files", "list of texts", NEEDED, "A file with one matrix for each value."),
        key(
            "powers",
            "list of whole numbers from −12 to 12",
            "0, 1, 2 and so on, one fewer than values",
            "The powers of the dimension in the matrix, all different.",
        ),
    ],
    examples: &["[[matrix]]
name = \"plate\"
role = \"stiffness\"
at = { dimension = \"thickness\", values = [0.0018, 0.0019, 0.002, 0.0021, 0.0022], files = [\"k18.mtx\", \"k19.mtx\", \"k20.mtx\", \"k21.mtx\", \"k22.mtx\"] }
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
        key("name", "text", "the only matrix in the file", "Name of the matrix in the file."),
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
    about: "A complex modulus E′(1 + iη), the same at all frequencies.\nThis form and the forms below are valid for `factor` and for `reference`.",
    keys: &[
        key(
            "storage",
            "number",
            NEEDED,
            "E′ in the unit of the factor. For a matrix assembled with a modulus of one, this is the unit of a modulus in the case's `units` (Pa, MPa …).",
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
    about: "A modulus over frequency, interpolated over log ω.\nThe table must cover every frequency that frfit computes.",
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
    about: "These keys stand together with the keys of any of these forms.\nThe error bars of all unknowns include this uncertainty.\nIf the measurements determine the factor better, frfit corrects the model for its error.",
    keys: &[
        key(
            "storage_std",
            "number, or a text such as \"2 %\"",
            "2 % if the band shows errors of the model, else none",
            "Standard deviation of E′, or of a real factor: in its unit, or relative as a percentage. For a factor that varies over frequency it is relative.",
        ),
        key(
            "loss_factor_std",
            "number, or a text such as \"20 %\"",
            "√(0.002² + (η/10)²) if the band shows errors of the model, else none",
            "Standard deviation of η: a number, or relative as a percentage.",
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
    about: "Names of the rows, if the matrix files have none.\nA degree of freedom is then a node, a sign and a direction: `12+Z`, `7-RX`.",
    keys: &[key("file", "text", NEEDED, "CSV with `row` (from 1), `node`, `direction` (X Y Z RX RY RZ).")],
    examples: &["[dofs]
file = \"dofs.csv\"
"],
};

pub(super) static LOAD: Section = Section {
    path: "load",
    title: "`[load]`",
    about: "Give one of the three keys.\nAn FRF is the response to a unit force at one degree of freedom.\nA file describes a distributed force; the measurement is then the response to this force as a whole.",
    keys: &[
        key("dof", "name such as 12+Z", "`row` or `file`", "DOF of a unit force; the sign gives its sense."),
        key("row", "whole number", "`dof` or `file`", "Row of a unit force, from 1."),
        key(
            "file",
            "text",
            "`dof` or `row`",
            "CSV with `row` (from 1), `re`, `im`, in N (N·m in a row with the name of a rotation).",
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
    about: "An accelerometer, the tip of a hammer, a suspension.\nGive `dof` or `row`, and at least one of `mass`, `mass_kg`, `stiffness` and `damping`.\nA number is in the `units` of the case; a text has its own units.\nThere is no rotary inertia.",
    keys: &[
        key("dof", "name such as 12+Z", "`row`", "Its DOF; a mass moves in all translations of that node."),
        key("row", "whole number", "`dof`", "Its row; a mass moves in this row only."),
        key("mass", "number above 0, or a text such as `12 g`", "no mass", "A point mass."),
        key("mass_kg", "number above 0, kg", "no mass", "A point mass in kg, for all `units`."),
        key(
            "directions",
            "list of X, Y, Z",
            "all translations of the node",
            "Directions in which the mass moves; only with `dof`.",
        ),
        key(
            "stiffness",
            "number above 0, or a text such as `3 N/mm`",
            "no spring",
            "A spring to ground: force over length, or moment over angle for a rotation (`5 N m/rad`).",
        ),
        key(
            "damping",
            "number above 0, or a text such as `0.2 N s/m`",
            "no damper",
            "A viscous damper to ground: force over velocity, or moment over angular velocity for a rotation.",
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
    about: "Each table is one FRF.\n`frfit sensitivities` and `frfit respond` need only the DOF of the sensor.\nWithout files `frfit modes` shows only the model.\nThe columns of a CSV file are separated by commas, semicolons or tabs.\nNumbers have a decimal point; with semicolons or tabs they may have a decimal comma.\nThe frequencies may be in any order, each of them once.",
    keys: &[
        key(
            "file",
            "text",
            "none, if the command needs no measurement",
            "UFF 58 or 58b, or CSV with `frequency_hz`, `re` and `im`, or `magnitude` (or `magnitude_db`, re 1 in SI units) and `phase_deg` (or `phase_rad`); if known, `coherence` or `std`, the standard deviation of the complex value (√2 times that of each part).",
        ),
        key(
            "columns",
            "list of names",
            "the first line of the table",
            "Names of the columns of a CSV file, in place of its own; `-` for a column that is not read.",
        ),
        key(
            "dof",
            "name such as 12+Z",
            "`row`, or the DOF in the file",
            "DOF of the sensor; the sign gives its sense.",
        ),
        key("row", "whole number", "`dof`, or the DOF in the file", "Row of the sensor, from 1."),
        key(
            "record",
            "whole number",
            "the FRF at this DOF",
            "Number of the FRF in a UFF file, from 1. Without it frfit takes the FRF at this DOF with the load of the case, or the one with the two exchanged (a hammer that moves).",
        ),
        key(
            "quantity",
            "\"receptance\", \"mobility\" or \"accelerance\"",
            "the quantity in the file",
            "Displacement, velocity or acceleration over force.",
        ),
        key(
            "averages",
            "whole number from 2",
            "the coherence sets only weights",
            "Number of averages of the coherence; with it frfit computes the standard deviation.",
        ),
        key(
            "scale",
            "number other than 0, or \"unknown\"",
            "1",
            "Factor for the values (9.80665 for g). \"unknown\": frfit identifies it, if another channel is known or the unknown is a law or a constant.",
        ),
        key(
            "delay_s",
            "number, s, or \"unknown\"",
            "0",
            "Time by which the channel is late: a phase of e^(−iωτ) in the file, which frfit removes. \"unknown\": as with `scale`.",
        ),
        key(
            "decay_per_s",
            "number from 0, 1/s",
            "the value in the file, or 0",
            "α = 1/τ of an exponential window e^(−αt) on force and response. frfit evaluates the model at ω − iα. The same for all measurements.",
        ),
        key(
            "window",
            "\"hann\" or \"none\"",
            "\"hann\" where the data show it",
            "Window of random excitation. A Hann window lowers and widens narrow resonances; frfit removes that. The same for all measurements.",
        ),
        key(
            "record_s",
            "number above 0, s",
            "1 over the spacing of the lines",
            "Length of the records under a Hann window.",
        ),
    ],
    examples: &[
        "[[measurement]]
file = \"frf.uff\"
dof = \"34+Z\"
record = 2
quantity = \"accelerance\"
averages = 5
scale = 9.80665
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
window = \"hann\"
record_s = 1.6
",
    ],
};

pub(super) static MODEL_ERROR: Section = Section {
    path: "model_error",
    title: "`[model_error]`",
    about: "Size of the errors of the model, as relative standard deviations: numbers, or texts such as \"0.5 %\".\nThey are in every error bar, even if a correct model explains the band.\n`model_error = \"0.5 %\"` is short for a table with `frequency` alone.\n`model_error = \"none\"` states that there are no errors.\nfrfit estimates the sizes that you do not give.",
    keys: &[
        key(
            "frequency",
            "number, or a text such as \"0.5 %\"",
            "estimated",
            "Error of natural frequencies, such as that of a mesh, at the upper end of the band.",
        ),
        key(
            "shape",
            "number, or a text such as \"3 %\"",
            "estimated",
            "Error of mode shapes at the sensors.",
        ),
        key(
            "calibration",
            "number, or a text such as \"1 %\"",
            "estimated",
            "Error of the calibrations of the force and of each sensor.",
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
    about: "The same structure on a coarser mesh, as its own case file.\n`coarser_mesh = \"coarse.toml\"` is short for a table with `file` alone.\nfrfit uses its matrices, `[load]`, `[dofs]`, `[[attached]]` and the DOFs of its measurements.\nIt does not use its measured FRFs.\nMatrices and measurements must have the same order as in this file.\nfrfit pairs the modes of both meshes, corrects the model for the error of this mesh, and includes its uncertainty in every error bar; see [Meshes](meshes.md).",
    keys: &[
        key("file", "text", NEEDED, "The case file."),
        key(
            "element_ratio",
            "number above 1",
            "2",
            "Ratio of the length of its elements to that of this mesh.",
        ),
        key(
            "order",
            "number above 0",
            "2",
            "Errors of natural frequencies are proportional to this power of the element length: 2 for linear solids, shells and beams with shear, 4 for cubic beams and quadratic solids.",
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
    about: "The unknown is the factor of a matrix, or a dimension; it is complex unless `real`.\nFor a single unknown both forms are valid.",
    keys: &[
        key(
            "name",
            "text",
            "names of the matrices",
            "Name of the unknown. A dimension needs it; for matrices with `at` it is their `dimension`.",
        ),
        key(
            "matrix",
            "text or list of texts",
            "the unknown is a dimension",
            "Matrix with the unknown factor; several matrices share one factor.",
        ),
        key(
            "powers",
            "table of matrices and whole numbers from −12 to 12",
            "matrices with `at`",
            "For a dimension: the factor of each matrix is multiplied by the dimension to this power.",
        ),
        key(
            "varies",
            "\"frequency\", \"smooth\", \"constant\" or \"law\"",
            "frequency; constant for a dimension",
            "A separate value at each frequency, a smooth curve (for a factor), one value for the band, or a law with few parameters.",
        ),
        key(
            "law",
            UnknownLawKind::EXPECTED,
            "all laws",
            "The law, with `varies = \"law\"`. For a single unknown also a list of laws, which frfit fits and compares.",
        ),
        key("branches", "whole number from 1 to 20", "3", "Number of branches with `law = \"maxwell\"`."),
        key(
            "nominal",
            "number",
            "required for a dimension, else the factor of the matrix",
            "Nominal value of a dimension: 1, or a length in the case's `units` if the matrices are assembled for a length of one.",
        ),
        key("bounds", "table, or [low, high] for a real unknown", "none", "Limits of the unknown."),
        key(
            "real",
            "true or false",
            "true for a dimension, else false",
            "The unknown is real, such as a density, a spring or a length.",
        ),
        key(
            "reference",
            "as `factor`",
            "none",
            "True value of a simulated measurement. frfit plots it and uses it for nothing else.",
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
    about: "If there are several unknowns, these keys are in the first table.",
    keys: &[
        key(
            "band_hz",
            "[low, high], Hz",
            "`--band`",
            "frfit uses the measured frequencies from low to high.",
        ),
        key(
            "exclude_hz",
            "list of frequencies and [low, high], Hz",
            "none",
            "Excluded frequencies, such as mains hum; their rows are `out_of_band`.",
        ),
        key(
            "max_lines",
            "whole number, 3 and more",
            "all",
            "Largest number of frequencies. frfit selects half of them evenly, and half where the measurement changes fastest. The others are `out_of_band`.",
        ),
        key(
            "reject_outliers",
            "true or false",
            "true",
            "Leave out one of three or more sensors if it contradicts all others.",
        ),
        key(
            "check",
            "true or false",
            "true",
            "Search for faults of the data, as `frfit check` does. A case with a single unknown that varies does it first, other cases only if the band is not explained.",
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
    about: "frfit refuses these keys if there are several unknowns.\nIt also refuses them if the only unknown is constant or has a negative power.\nFor those there is only one method.\n\
            Laws and smooth moduli need the default method.",
    keys: &[
        key(
            "method",
            "\"rational\", \"series\" or \"nelder-mead\"",
            "rational",
            "All solutions on a reduced model; the Neumann series of the paper; a search for comparison.",
        ),
        key(
            "order",
            "whole number from 1 to 200",
            "30",
            "Series: number of terms. Rational: largest number of terms. Nelder–Mead: number of iterations.",
        ),
        key(
            "selection",
            "\"joint\" or \"smallest\"",
            "joint with rational, else smallest",
            "Selection among several solutions: by all sensors and frequencies together, or the smallest correction (the paper).",
        ),
        key(
            "reduction",
            "\"auto\", \"full\" or \"subspace\"",
            "auto",
            "Model at each frequency: the full model, or one reduced model for the band.",
        ),
        key(
            "start",
            "\"bounds\"",
            "the factor of the matrix",
            "There is no nominal value. frfit searches the whole range of the bounds and requires `bounds.storage`. Not for a dimension.",
        ),
    ],
    examples: &[
        "[identify]
matrix = \"mass\"
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
    about: "Wide limits from prior knowledge, in the unit of the factor and the `units` of the case.\nThe low limit may equal the high limit for a single unknown that varies; otherwise it must be below.",
    keys: &[
        key(
            "storage",
            "[low, high]",
            "none",
            "Limits of E′, or of a real factor. frfit first searches within a factor of four of the nominal value, and about another one where the natural frequencies show that.",
        ),
        key("loss_factor", "[low, high]", "none", "Limits of η."),
    ],
    examples: &["[identify]
matrix = \"plate\"
bounds = { storage = [1e10, 1e12], loss_factor = [0.0, 0.5] }
"],
};

pub(super) static RESPOND: Section = Section {
    path: "respond",
    title: "`[respond]`",
    about: "Frequencies for `frfit respond` and `frfit sensitivities`.\nWithout `[identify]` this is also the band for `frfit modes`.",
    keys: &[
        key("band_hz", "[low, high], Hz", NEEDED, "First and last frequency."),
        key(
            "points",
            "whole number from 1 to 1000000",
            NEEDED,
            "Number of frequencies, equally spaced, with both ends.",
        ),
    ],
    examples: &["[respond]
band_hz = [10.0, 2000.0]
points = 400
"],
};

pub(super) static SOLVER: Section = Section {
    path: "solver",
    title: "`[solver]`",
    about: "What factorises the matrices.\n`engine = \"mumps\"` starts MUMPS in processes of its own (ranks), on this machine or on the machines of an MPI job; see [Clusters](clusters.md).\nIt serves models that do not fit into one machine.\nThe command line has the options `--engine` and `--launch` for the same.",
    keys: &[
        key(
            "engine",
            "\"multifrontal\" or \"mumps\"",
            NEEDED,
            "\"multifrontal\" is frfit's own solver, in its own process.",
        ),
        key(
            "launch",
            "text",
            "\"mpirun\"",
            "Command that starts the ranks: `mpirun`, `mpiexec` or `srun`, and how many ranks run where. \
             Any other command is accepted only as `--launch`, because a case file must not run programs.",
        ),
        key(
            "host",
            "text",
            "this machine alone",
            "Name of this machine in the network, if rank 0 runs on another machine.",
        ),
        key(
            "out_of_core",
            "text",
            "factors in memory",
            "Folder on each rank's machine, for factors on disk: less memory, more time.",
        ),
    ],
    examples: &["[solver]
engine = \"mumps\"
launch = \"mpirun -n 4\"
host = \"node01\"
out_of_core = \"/scratch\"
"],
};
