//! The tables of a case file, one function each.

use super::entries::{
    AtValues, AttachedEntry, Calibration, CoarserMeshEntry, FactorEntry, LoadEntry, Located, MatrixEntry,
    MeasurementEntry, MumpsEntry, RandomWindow, RespondEntry, SolverEntry, Spot,
};
use super::field::{Field, Table};
use super::keys;
use super::launcher;
use crate::error::{InputError, Place};
use crate::units::{Amount, AmountOf, UnitSystem, UnknownSystem, amount};
use frfit::c64;
use frfit::dof::{Axis, DofName};
use frfit::identify::{CoarserMesh, ErrorSizes, ModelErrors};
use frfit::laws::{LawKind, Parameter, ParameterKind};
use frfit::material::{Branch, Law};
use frfit::model::{FactorStd, Role};
use frfit::quantity::Quantity;

/// `units`.
pub(super) fn units(field: &Field<'_>) -> Result<UnitSystem, InputError> {
    let Located { value, place } = field.text()?;
    value.parse().map_err(|unknown: UnknownSystem| InputError::at(&place, unknown.expected, unknown.found))
}

/// `[[matrix]]`.
pub(super) fn matrix(table: &Table<'_>) -> Result<MatrixEntry, InputError> {
    let name = table.need("name")?.text()?;
    let role = table.need("role")?.word(|word| match word {
        "stiffness" => Ok(Role::Stiffness),
        "mass" => Ok(Role::Mass),
        "viscous" => Ok(Role::Viscous),
        _ => Err("\"stiffness\", \"mass\" or \"viscous\"".into()),
    })?;
    let one = || FactorEntry::Law(Law::Constant(c64::new(1.0, 0.0)));
    let (factor, factor_std) = match table.find("factor") {
        Some(field) => factor_of_matrix(&field)?,
        None => (Located { value: one(), place: name.place.clone() }, None),
    };
    if let (Some(std), Role::Mass | Role::Viscous) = (&factor_std, role.value)
        && std.value.loss_factor.is_some()
    {
        let found = "that of a mass or a damping";
        return Err(InputError::at(&std.place, "loss_factor_std of a stiffness", found));
    }
    let factor_is = |word: &str| match word {
        "modulus" => Ok(true),
        "relative" => Ok(false),
        _ => Err("\"modulus\" or \"relative\"".to_owned()),
    };
    let factor_is = table.find("factor_is").map(|field| field.word(factor_is)).transpose()?;
    if let (Some(given), Role::Mass | Role::Viscous) = (&factor_is, role.value) {
        let found = "that of a mass or a damping";
        return Err(InputError::at(&given.place, "the factor of a stiffness", found));
    }
    let factor_is_modulus = factor_is.map(|given| given.value);
    let at = table.find("at").map(|field| at_values(&field)).transpose()?;
    let (file, in_file) = match (&at, table.find("file")) {
        (None, _) => matrix_file(&table.need("file")?)?,
        (Some(at), None) => (at.files[0].1.clone(), None),
        (Some(_), Some(file)) => return Err(InputError::at(&file.place, "one of file and at", "both")),
    };
    if let (Some(_), Some(std)) = (&at, &factor_std) {
        return Err(InputError::at(
            &std.place,
            "a matrix that is given once",
            "one with values of a dimension",
        ));
    }
    Ok(MatrixEntry { name, role: role.value, file, in_file, at, factor, factor_std, factor_is_modulus })
}

/// `at = { dimension = "thickness", values = [0.8, 1.0, 1.2], files = ["k08.mtx", "k10.mtx", "k12.mtx"] }`.
fn at_values(field: &Field<'_>) -> Result<AtValues, InputError> {
    let table = field.table(&[&keys::MATRIX_AT])?;
    let values = table.need("values")?;
    let numbers = values.each("a list of numbers", |field| field.number())?;
    let files = table.need("files")?.texts()?;
    let powers = table.find("powers").map(|field| at_powers(&field)).transpose()?;
    check_values(&numbers, &values.place, powers.as_ref().map(|powers| &powers.value[..]))?;
    if files.len() != numbers.len() {
        let expected = format!("{} files, one for each value", numbers.len());
        return Err(InputError::at(&table.need("files")?.place, expected, files.len().to_string()));
    }
    Ok(AtValues {
        dimension: table.need("dimension")?.text()?,
        files: numbers.into_iter().zip(files).collect(),
        powers,
    })
}

/// Checks the values of a dimension at which a matrix is given, from which its parts for some powers are computed: 0, 1, 2 and so on without `powers`.
///
/// # Errors
/// Too few values or too many, the same value twice, or one that is not allowed: 0, or with `powers` a negative one.
pub(crate) fn check_values(numbers: &[f64], place: &Place, powers: Option<&[i32]>) -> Result<(), InputError> {
    match powers {
        Some(powers) if numbers.len() != powers.len() + 1 => {
            let count = powers.len();
            let expected =
                format!("{} values: one for each of {count} powers, and one that checks them", count + 1);
            return Err(InputError::at(place, expected, numbers.len().to_string()));
        }
        None if numbers.len() < LEAST_VALUES || numbers.len() > MOST_VALUES => {
            let expected = format!(
                "from {LEAST_VALUES} to {MOST_VALUES} values: a polynomial goes through all but one, which checks it"
            );
            return Err(InputError::at(place, expected, numbers.len().to_string()));
        }
        _ => {}
    }
    // With powers a matrix of two values of opposite sign may be the same one twice, and a negative power of zero does not exist.
    let (allowed, expected): (fn(f64) -> bool, _) = match powers {
        Some(_) => (|value| value > 0.0, "values above 0, each once"),
        None => (|value| value != 0.0, "values other than 0, each once"),
    };
    let wrong = |k: &usize| numbers[..*k].contains(&numbers[*k]) || !allowed(numbers[*k]);
    if let Some(k) = (0..numbers.len()).find(wrong) {
        return Err(InputError::at(place, expected, numbers[k].to_string()));
    }
    Ok(())
}

/// The largest power of a dimension, and its least.
pub(super) const MOST_POWER: i64 = 12;

/// Values at which a matrix may be given: a straight line and its check at least; no matrix has ninth powers of a dimension.
const LEAST_VALUES: usize = 3;
const MOST_VALUES: usize = 10;

/// `powers = [-1, 0, 1]` of `at`: each once.
fn at_powers(field: &Field<'_>) -> Result<Located<Vec<i32>>, InputError> {
    let powers = field.each(&expected_powers(), |item| {
        let power = item.whole()?.value;
        match (-MOST_POWER..=MOST_POWER).contains(&power) {
            true => Ok(power as i32),
            false => Err(item.refuse(&format!("a whole number from -{MOST_POWER} to {MOST_POWER}"))),
        }
    })?;
    match are_powers(&powers) {
        true => Ok(Located { value: powers, place: field.place.clone() }),
        false => Err(field.refuse(&expected_powers())),
    }
}

/// What `powers` of a dimension have to be.
pub(crate) fn expected_powers() -> String {
    format!("a list of 1 to {} whole numbers, each once", MOST_VALUES - 1)
}

/// Whether a list is one of different powers, not too many.
pub(crate) fn are_powers(powers: &[i32]) -> bool {
    let twice = (1..powers.len()).any(|k| powers[..k].contains(&powers[k]));
    !twice && !powers.is_empty() && powers.len() < MOST_VALUES
}

/// A file of one matrix, or a file and the name of one of its matrices.
fn matrix_file(field: &Field<'_>) -> Result<(Located<String>, Option<Located<String>>), InputError> {
    if field.is_text() {
        return Ok((field.text()?, None));
    }
    if !field.is_table() {
        return Err(field.refuse("a text in quotes or { file = \"...\", name = \"...\" }"));
    }
    let table = field.table(&[&keys::MATRIX_FILE])?;
    Ok((table.need("file")?.text()?, table.find("name").map(|name| name.text()).transpose()?))
}

/// A factor without standard deviations.
pub(super) fn factor(field: &Field<'_>) -> Result<Located<FactorEntry>, InputError> {
    read_factor(field, &[])
}

/// A number, a complex modulus, a law, or a table; `more` are the keys that may stand beside any of them.
fn read_factor(field: &Field<'_>, more: More) -> Result<Located<FactorEntry>, InputError> {
    let located = |value| Located { value, place: field.place.clone() };
    if let Some(number) = field.as_number() {
        return Ok(located(FactorEntry::Law(Law::Constant(c64::new(number, 0.0)))));
    }
    if !field.is_table() {
        return Err(field.refuse(&format!(
            "a finite number, {{ storage = ..., loss_factor = ... }}, {} or {{ table = \"file\" }}",
            laws_written()
        )));
    }
    let any = field.table(&[&forms(), more].concat())?;
    if any.find("table").is_some() {
        let file = field.table(&[&[&keys::TABLE], more].concat())?.need("table")?.text()?;
        return Ok(located(FactorEntry::Table(file)));
    }
    let law = if any.find("law").is_some() { law(field, &any, more)? } else { complex_modulus(field, more)? };
    Ok(located(FactorEntry::Law(law)))
}

/// The factor of a matrix, and how well it is known.
fn factor_of_matrix(
    field: &Field<'_>,
) -> Result<(Located<FactorEntry>, Option<Located<FactorStd>>), InputError> {
    let entry = read_factor(field, STD)?;
    let find = |key: &str| -> Result<Option<Field<'_>>, InputError> {
        Ok(if field.is_table() { field.table(&[&forms(), STD].concat())?.find(key) } else { None })
    };
    let (storage, loss_factor) = (find("storage_std")?, find("loss_factor_std")?);
    let Some(place) = storage.as_ref().or(loss_factor.as_ref()).map(|field| field.place.clone()) else {
        return Ok((entry, None));
    };
    // Of a factor that varies there is no one number to which another would belong.
    let constant = match &entry.value {
        FactorEntry::Law(Law::Constant(value)) => Some(*value),
        _ => None,
    };
    let relative = |field: &Field<'_>| {
        let number = field.as_number().zip(constant).map(|(std, factor)| std / factor.re.abs());
        let std = if field.is_text() { field.share() } else { number };
        let expected = match constant {
            Some(_) => "a number above 0 in the unit of storage, or a text as \"2 %\"",
            None => "a text as \"2 %\", for a factor that varies",
        };
        std.filter(|std| *std > 0.0 && std.is_finite()).ok_or_else(|| field.refuse(expected))
    };
    let absolute = |field: &Field<'_>| {
        let share = field.share().zip(constant).map(|(share, factor)| share * (factor.im / factor.re).abs());
        let std = if field.is_text() { share } else { field.as_number() };
        let expected = "a number above 0, or a text as \"20 %\" of a constant loss factor";
        std.filter(|std| *std > 0.0 && std.is_finite()).ok_or_else(|| field.refuse(expected))
    };
    let std = FactorStd {
        storage: storage.as_ref().map(relative).transpose()?,
        loss_factor: loss_factor.as_ref().map(absolute).transpose()?,
    };
    Ok((entry, Some(Located { value: std, place })))
}

/// Sections of keys beside those of a form.
type More = &'static [&'static keys::Section];

/// Those of how well a factor is known.
static STD: More = &[&keys::FACTOR_STD];

/// All keys of factors.
fn forms() -> Vec<&'static keys::Section> {
    let laws = keys::LAWS.iter().map(|(_, section)| section);
    std::iter::once(&keys::COMPLEX_MODULUS).chain(laws).chain([&keys::TABLE]).collect()
}

/// How laws are written, the first with all its parameters.
fn laws_written() -> String {
    let written = |(k, (kind, _)): (usize, &(LawKind, keys::Section))| {
        let names = kind.parameters().into_iter().map(|parameter| format!("{} = ...", parameter.name));
        let rest = if k == 0 { names.collect::<Vec<_>>().join(", ") } else { "...".into() };
        format!("{{ law = {:?}, {rest} }}", kind.word())
    };
    keys::LAWS.iter().enumerate().map(written).collect::<Vec<_>>().join(", ")
}

fn complex_modulus(field: &Field<'_>, more: More) -> Result<Law, InputError> {
    let table = field.table(&[&[&keys::COMPLEX_MODULUS], more].concat())?;
    let storage = table.need("storage")?.number()?;
    let loss_factor = table.find("loss_factor").map(|field| field.number()).transpose()?.unwrap_or(0.0);
    if !(storage * loss_factor).is_finite() {
        let found = format!("{storage:?} * {loss_factor:?}");
        return Err(InputError::at(&field.place, "a finite storage * loss_factor", found));
    }
    Ok(Law::complex_modulus(storage, loss_factor))
}

/// A law by its name; `any` is its table with all keys that some law has.
fn law(field: &Field<'_>, any: &Table<'_>, more: More) -> Result<Law, InputError> {
    let named = |word: &str| keys::LAWS.iter().find(|(kind, _)| kind.word() == word);
    let found = any.need("law")?.word(|word| named(word).ok_or_else(keys::law_words))?;
    let (kind, section) = found.value;
    let table = field.table(&[&[section], more].concat())?;
    if let LawKind::Maxwell { .. } = kind {
        return maxwell(&table);
    }
    let value = |parameter: Parameter| {
        let found = table.need(&parameter.name)?;
        let value = found.number()?;
        match parameter.kind.allows(value) {
            true => Ok(value),
            false => Err(found.refuse(parameter.kind.expected())),
        }
    };
    let p = kind.parameters().into_iter().map(value).collect::<Result<Vec<f64>, InputError>>()?;
    Ok(kind.law(&p))
}

fn maxwell(table: &Table<'_>) -> Result<Law, InputError> {
    let e0 = table.need("e0")?.number()?;
    let list = table.need("branches")?;
    let branches: Vec<Branch> = (list.pairs("at least one branch [modulus, time]")?.into_iter())
        .map(|[modulus, tau_s]| Branch { modulus, tau_s })
        .collect();
    match branches.iter().all(|branch| ParameterKind::Time.allows(branch.tau_s)) {
        true => Ok(Law::Maxwell { e0, branches }),
        false => Err(list.refuse("branches [modulus, time] with times above 0 s")),
    }
}

/// `dof` or `row`, if one is there.
fn spot(table: &Table<'_>) -> Result<Option<Spot>, InputError> {
    match (table.find("dof"), table.find("row")) {
        (Some(_), Some(row)) => Err(InputError::at(&row.place, "either dof or row", "both")),
        (Some(dof), None) => {
            let expected = "a node, a sign and a direction such as 12+Z or 7-RX";
            let name = dof.word(|word| word.parse::<DofName>().map_err(|_| expected.into()))?;
            Ok(Some(Spot::Dof(name)))
        }
        (None, Some(row)) => Ok(Some(Spot::Row(row.whole()?))),
        (None, None) => Ok(None),
    }
}

/// `[[attached]]`.
pub(super) fn attached(table: &Table<'_>) -> Result<AttachedEntry, InputError> {
    let positive =
        |key: &str, of: AmountOf| table.find(key).map(|field| attached_amount(&field, of)).transpose();
    let mass_kg = table.find("mass_kg").map(|field| match field.number()? {
        value if value > 0.0 => Ok(Amount::Si { value, rotational: false }),
        _ => Err(field.refuse("a mass above 0 kg")),
    });
    let (mass, mass_kg) = (positive("mass", AmountOf::Mass)?, mass_kg.transpose()?);
    if let (Some(_), Some(field)) = (mass, table.find("mass_kg")) {
        return Err(InputError::at(&field.place, "one of mass and mass_kg", "both"));
    }
    let mass = mass.or(mass_kg);
    let stiffness = positive("stiffness", AmountOf::Stiffness)?;
    let damping = positive("damping", AmountOf::Damping)?;
    let spot = spot(table)?
        .ok_or_else(|| InputError::at(&table.place, "the key \"dof\" or \"row\", where it is", "none"))?;
    if mass.or(stiffness).or(damping).is_none() {
        let expected = "one of the keys mass, mass_kg, stiffness and damping";
        return Err(InputError::at(&table.place, expected, "none"));
    }
    let directions = match table.find("directions") {
        Some(field) => Some(directions(&field, &spot, mass)?),
        None => None,
    };
    Ok(AttachedEntry { place: table.place.clone(), spot, mass, directions, stiffness, damping })
}

/// A number above 0 in units of the case, or a text with units of its own.
fn attached_amount(field: &Field<'_>, of: AmountOf) -> Result<Amount, InputError> {
    let what = match of {
        AmountOf::Mass => "a mass",
        AmountOf::Stiffness => "a stiffness",
        AmountOf::Damping => "a damping",
    };
    let expected =
        format!("{what} above 0: a number in the units of the case, or a text as {:?}", of.example());
    let found = match field.is_text() {
        true => {
            let Located { value, place } = field.text()?;
            amount(&value, of).map_err(|found| InputError::at(&place, &expected, found))?
        }
        false => Amount::OfModel(field.as_number().ok_or_else(|| field.refuse(&expected))?),
    };
    if found.value() > 0.0 { Ok(found) } else { Err(field.refuse(&expected)) }
}

/// The directions in which a mass moves with its node.
fn directions(
    field: &Field<'_>,
    spot: &Spot,
    mass: Option<Amount>,
) -> Result<Vec<Located<Axis>>, InputError> {
    const EXPECTED: &str = "a list of \"X\", \"Y\" and \"Z\", each at most once";
    if mass.is_none() {
        return Err(InputError::at(&field.place, "the key mass or mass_kg beside it", "none"));
    }
    if let Spot::Row(_) = spot {
        let found = "row, which has no node";
        return Err(InputError::at(&field.place, "dof beside it", found));
    }
    let axis = |word: &str| {
        let translations = Axis::ALL.into_iter().take(3);
        let found = translations.into_iter().find(|axis| axis.name().eq_ignore_ascii_case(word));
        found.ok_or_else(|| EXPECTED.to_owned())
    };
    let axes = field.each(EXPECTED, |item| item.word(axis))?;
    let twice = (1..axes.len()).any(|k| axes[..k].iter().any(|axis| axis.value == axes[k].value));
    if axes.is_empty() || twice { Err(field.refuse(EXPECTED)) } else { Ok(axes) }
}

/// `[load]`.
pub(super) fn load(table: &Table<'_>) -> Result<LoadEntry, InputError> {
    match (spot(table)?, table.find("file")) {
        (Some(_), Some(file)) => Err(InputError::at(&file.place, "one of dof, row and file", "two of them")),
        (Some(spot), None) => Ok(LoadEntry::At(spot)),
        (None, Some(file)) => Ok(LoadEntry::File(file.text()?)),
        (None, None) => Err(InputError::at(&table.place, "one of the keys dof, row and file", "none")),
    }
}

/// `[[measurement]]`.
pub(super) fn measurement(table: &Table<'_>) -> Result<MeasurementEntry, InputError> {
    let quantity = |field: Field<'_>| {
        let expected = "\"receptance\", \"mobility\" or \"accelerance\"";
        field.word(|word| word.parse::<Quantity>().map_err(|_| expected.into()))
    };
    Ok(MeasurementEntry {
        place: table.place.clone(),
        file: table.find("file").map(|file| file.text()).transpose()?,
        spot: spot(table)?,
        columns: table.find("columns").map(|field| columns(&field)).transpose()?,
        record: table.find("record").map(|record| record.whole()).transpose()?,
        quantity: table.find("quantity").map(quantity).transpose()?.map(|quantity| quantity.value),
        averages: table.find("averages").map(|field| averages(&field)).transpose()?,
        scale: table
            .find("scale")
            .map(|field| calibration(&field, SCALE, |scale| scale != 0.0))
            .transpose()?,
        delay_s: table.find("delay_s").map(|field| calibration(&field, DELAY, |_| true)).transpose()?,
        decay_per_s: table.find("decay_per_s").map(|field| decay(&field)).transpose()?,
        window: table.find("window").map(|field| field.word(str::parse::<RandomWindow>)).transpose()?,
        record_s: table.find("record_s").map(|field| record(&field)).transpose()?,
    })
}

const SCALE: &str = "a finite number other than 0, or \"unknown\"";
const DELAY: &str = "a finite number of seconds, or \"unknown\"";

/// A number, or that it is to be found.
fn calibration(
    field: &Field<'_>,
    expected: &str,
    possible: impl Fn(f64) -> bool,
) -> Result<Located<Calibration>, InputError> {
    match field.as_number() {
        Some(number) if possible(number) => {
            Ok(Located { value: Calibration::Known(number), place: field.place.clone() })
        }
        _ => match field.word(|word| (word == "unknown").then_some(()).ok_or_else(|| expected.to_owned())) {
            Ok(word) => Ok(Located { value: Calibration::Unknown, place: word.place }),
            Err(_) => Err(field.refuse(expected)),
        },
    }
}

/// The decay rate of an exponential window.
fn decay(field: &Field<'_>) -> Result<Located<f64>, InputError> {
    match field.as_number().filter(|value| *value >= 0.0) {
        Some(value) => Ok(Located { value, place: field.place.clone() }),
        None => Err(field.refuse("a finite number of 1/s that is not negative")),
    }
}

/// The length of records.
fn record(field: &Field<'_>) -> Result<f64, InputError> {
    let positive = field.as_number().filter(|value| *value > 0.0);
    positive.ok_or_else(|| field.refuse("a number of seconds above 0"))
}

/// Names of columns.
fn columns(field: &Field<'_>) -> Result<Located<Vec<String>>, InputError> {
    const EXPECTED: &str = "a list of names such as [\"frequency_hz\", \"magnitude\", \"phase_deg\", \"-\"]";
    let names = field.each(EXPECTED, |item| item.text())?;
    if names.is_empty() {
        return Err(field.refuse(EXPECTED));
    }
    Ok(Located { value: names.into_iter().map(|name| name.value).collect(), place: field.place.clone() })
}

/// A number of averages: a coherence of one record is 1 whatever was measured.
fn averages(field: &Field<'_>) -> Result<Located<i64>, InputError> {
    let averages = field.whole()?;
    if averages.value < 2 {
        return Err(field.refuse("a whole number from 2 on: the coherence of one record is always 1"));
    }
    Ok(averages)
}

/// `model_error = "estimated"`, `"none"` or a size, or `[model_error]`.
pub(super) fn model_error(field: &Field<'_>) -> Result<ModelErrors, InputError> {
    const EXPECTED: &str = "\"estimated\", \"none\", a number above 0 up to 0.5, or a text as \"0.5 %\"";
    let size = |field: &Field<'_>, expected: &str| match field.share() {
        Some(size) if size > 0.0 && size <= 0.5 => Ok(size),
        _ => Err(field.refuse(expected)),
    };
    if !field.is_table() {
        let word = field.text().ok().and_then(|word| word.value.parse::<ModelErrors>().ok());
        let sized = |size| ModelErrors::Given(ErrorSizes::default().with_frequency(Some(size)));
        return word.map_or_else(|| size(field, EXPECTED).map(sized), Ok);
    }
    let table = field.table(&[&keys::MODEL_ERROR])?;
    let of = |key: &str, example: &str| {
        let expected = format!("a number above 0 up to 0.5, or a text as {example:?}");
        table.find(key).map(|field| size(&field, &expected)).transpose()
    };
    let sizes = ErrorSizes::default()
        .with_frequency(of("frequency", "0.5 %")?)
        .with_shape(of("shape", "3 %")?)
        .with_calibration(of("calibration", "1 %")?);
    match sizes.any() {
        true => Ok(ModelErrors::Given(sizes)),
        false => {
            Err(InputError::at(&field.place, "one of the keys frequency, shape and calibration", "none"))
        }
    }
}

/// `coarser_mesh = "coarse.toml"`, or `[coarser_mesh]`.
pub(super) fn coarser_mesh(field: &Field<'_>) -> Result<CoarserMeshEntry, InputError> {
    if field.is_text() {
        return Ok(CoarserMeshEntry { file: field.text()?, element_ratio: None, order: None });
    }
    if !field.is_table() {
        return Err(field.refuse("a text in quotes or { file = \"...\", element_ratio = ..., order = ... }"));
    }
    let table = field.table(&[&keys::COARSER_MESH])?;
    let above = |key: &str, least: f64| {
        let number = |field: Field<'_>| {
            let number = field.number()?;
            let is_usual = number > least && number <= CoarserMesh::MAX_RATIO;
            let expected = format!("a number above {least} up to {}", CoarserMesh::MAX_RATIO);
            if is_usual { Ok(number) } else { Err(field.refuse(&expected)) }
        };
        table.find(key).map(number).transpose()
    };
    Ok(CoarserMeshEntry {
        file: table.need("file")?.text()?,
        element_ratio: above("element_ratio", 1.0)?,
        order: above("order", 0.0)?,
    })
}

/// `[solver]`.
pub(super) fn solver(field: &Field<'_>) -> Result<SolverEntry, InputError> {
    let table = field.table(&[&keys::SOLVER])?;
    let engine = table.need("engine")?.word(|word| match word {
        "multifrontal" => Ok(false),
        "mumps" => Ok(true),
        _ => Err("\"multifrontal\" or \"mumps\"".into()),
    })?;
    let text = |key: &str| table.find(key).map(|field| field.text()).transpose();
    let [launch, host, folder] = [text("launch")?, text("host")?, text("out_of_core")?];
    if let Some(of_mumps) = [&launch, &host, &folder].into_iter().flatten().next()
        && !engine.value
    {
        return Err(InputError::at(
            &of_mumps.place,
            "a key of engine = \"mumps\"",
            "engine = \"multifrontal\"",
        ));
    }
    if let Some(launch) = &launch {
        launcher::is_harmless(&launch.value).map_err(|found| {
            let expected = format!("{}; any other command only as --launch", launcher::HARMLESS);
            InputError::at(&launch.place, expected, found)
        })?;
    }
    let mumps = MumpsEntry {
        place: engine.place,
        launch: launch.map_or_else(|| launcher::DEFAULT.to_owned(), |launch| launch.value),
        host: host.map(|host| host.value),
        out_of_core: folder.map(|folder| folder.value),
    };
    Ok(SolverEntry { mumps: engine.value.then_some(mumps) })
}

/// `[respond]`.
pub(super) fn respond(field: &Field<'_>) -> Result<RespondEntry, InputError> {
    const MOST: i64 = 1_000_000;
    let table = field.table(&[&keys::RESPOND])?;
    let points = table.need("points")?;
    let count = points.whole()?.value;
    if !(1..=MOST).contains(&count) {
        return Err(points.refuse(&format!("1 to {MOST}")));
    }
    Ok(RespondEntry { band_hz: band(&table.need("band_hz")?)?, points: count as usize })
}

pub(super) fn band(field: &Field<'_>) -> Result<Located<[f64; 2]>, InputError> {
    let band = field.pair()?;
    checked_band(band.value, &band.place)?;
    Ok(band)
}

/// Refuses a band that is not valid, wherever it comes from.
///
/// # Errors
/// Frequencies that are negative, not finite, or descending.
pub(crate) fn checked_band([low, high]: [f64; 2], place: &Place) -> Result<(), InputError> {
    match 0.0 <= low && low <= high && high.is_finite() {
        true => Ok(()),
        false => Err(InputError::at(
            place,
            "two frequencies [low, high] in Hz with 0 <= low <= high",
            format!("[{low}, {high}]"),
        )),
    }
}
