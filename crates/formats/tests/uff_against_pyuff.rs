//! pyuff reads the same from the sample files and from files written here, number for number.
//!
//! What pyuff 2.4.2 reads is known; xtask installs that version.

use crate::{outside, uff_support};

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use frfit_formats::uff::{
    self, Axis, DataType, Dof, Endian, Form, Function, Node, Record, Spacing, Units, Values,
};

use uff_support::{function, variants};

/// What pyuff reads from these files, one text a file.
fn dumps(python: &str, files: &[PathBuf]) -> Vec<String> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/uff_support/dump.py");
    let output = Command::new(python).arg(script).args(files).output().expect("Python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let mut dumps: Vec<String> = text.split("\nend\n").map(str::to_owned).collect();
    assert_eq!(dumps.pop(), Some(String::new()));
    assert_eq!(dumps.len(), files.len());
    dumps
}

/// Reads a dump line by line.
struct Dump<'a> {
    lines: std::str::Split<'a, char>,
    place: String,
}

impl<'a> Dump<'a> {
    fn line(&mut self) -> &'a str {
        self.lines.next().unwrap_or_else(|| panic!("{}: the dump ends", self.place))
    }

    /// The text is the same but for what pyuff, which reads UTF-8 only, cannot read.
    fn text(&mut self, ours: &str) {
        let theirs = self.line();
        let blurred = |text: &str| text.replace(|c: char| !c.is_ascii(), "?");
        let ours = if ours.is_empty() && theirs == "NONE" { "NONE" } else { ours };
        if theirs.contains('\u{fffd}') {
            assert_eq!(blurred(ours), blurred(theirs), "{}", self.place);
        } else {
            assert_eq!(ours, theirs, "{}", self.place);
        }
    }

    fn integers(&mut self, ours: &[i64]) {
        let theirs: Vec<i64> = self.line().split(' ').map(|word| word.parse().expect("an integer")).collect();
        assert_eq!(ours, theirs, "{}", self.place);
    }

    /// The numbers have the same bits; −0 is 0, since pyuff adds the parts of a complex number up.
    fn reals(&mut self, ours: impl IntoIterator<Item = f64>) {
        let theirs = self.line().split(' ').filter(|word| !word.is_empty());
        let theirs: Vec<u64> = theirs.map(|word| u64::from_str_radix(word, 16).expect("bits")).collect();
        let positive_zero = |bits: u64| if bits == (-0.0_f64).to_bits() { 0 } else { bits };
        let ours: Vec<u64> = ours.into_iter().map(|value| positive_zero(value.to_bits())).collect();
        let theirs: Vec<u64> = theirs.into_iter().map(positive_zero).collect();
        assert_eq!(ours.len(), theirs.len(), "{}", self.place);
        let different = ours.iter().zip(&theirs).position(|(a, b)| a != b);
        assert_eq!(different, None, "{}: place of the first number that differs", self.place);
    }

    fn function(&mut self, function: &Function) {
        let Function { header, abscissa, values } = function;
        header.id.iter().for_each(|id| self.text(id));
        self.text(&header.response.entity);
        self.text(&header.reference.entity);
        let dof = |dof: &Dof| [dof.node, dof.direction.into()];
        let (points, even) = (i64::try_from(header.points), i64::from(header.spacing != Spacing::Uneven));
        let kind = [header.function_type.number().into(), header.function_id, header.version.into()];
        let form = [header.data_type.number(), points.expect("a count"), even];
        let [response, reference] = [&header.response, &header.reference].map(dof);
        self.integers(&[&kind[..], &[header.load_case], &response, &reference, &form].concat());
        let (minimum, increment) = match header.spacing {
            Spacing::Even { minimum, increment } => (minimum, increment),
            Spacing::Uneven => (0.0, 0.0),
        };
        self.reals([minimum, increment, header.z_value]);
        for axis in [&header.abscissa, &header.ordinate, &header.denominator, &header.z_axis] {
            self.axis(axis);
        }
        self.reals(abscissa.iter().copied());
        match values {
            Values::Real(values) => self.reals(values.iter().copied()),
            Values::Complex(values) => self.reals(values.iter().flat_map(|value| [value.re, value.im])),
        }
    }

    fn axis(&mut self, axis: &Axis) {
        let exponents = [axis.length_exponent, axis.force_exponent, axis.temperature_exponent];
        let [length, force, temperature] = exponents.map(i64::from);
        self.integers(&[axis.quantity.number().into(), length, force, temperature]);
        self.text(&axis.label);
        self.text(&axis.unit);
    }

    fn nodes(&mut self, nodes: &[Node]) {
        // pyuff reads integers as floating point numbers.
        self.reals(nodes.iter().map(|node| node.label as f64));
        self.reals(nodes.iter().map(|node| node.definition_system as f64));
        self.reals(nodes.iter().map(|node| node.displacement_system as f64));
        self.reals(nodes.iter().map(|node| node.color as f64));
        for k in 0..3 {
            self.reals(nodes.iter().map(|node| node.position[k]));
        }
    }

    fn units(&mut self, units: &Units) {
        self.integers(&[units.code.into(), units.temperature_mode.into()]);
        self.text(&units.description);
        self.reals([units.length, units.force, units.temperature, units.temperature_offset]);
    }

    fn record(&mut self, record: &Record) {
        match record {
            Record::Function(function) => self.function(function),
            Record::Nodes(nodes) => self.nodes(nodes),
            Record::Units(units) => self.units(units),
            Record::TraceLine(line) => {
                let count = i64::try_from(line.nodes.len()).expect("a count");
                self.integers(&[line.number, count, line.color]);
                self.text(&line.name);
                // pyuff keeps what fills up the last line.
                let all = self.line();
                let kept: Vec<&str> = all.split(' ').take(line.nodes.len()).collect();
                let ours: Vec<String> =
                    line.nodes.iter().map(|&node| format!("{:016x}", (node as f64).to_bits())).collect();
                assert_eq!(ours, kept, "{}", self.place);
            }
            Record::FileHeader(header) => {
                for text in [&header.model, &header.description, &header.created_by, &header.written_by] {
                    self.text(text);
                }
            }
            Record::Other { dataset, .. } => panic!("{}: {dataset} is not dumped", self.place),
        }
    }
}

/// Compares every dataset that pyuff could read; returns their number.
fn compare(path: &Path, dump: &str) -> usize {
    let bytes = fs::read(path).expect("a readable file");
    let file = uff::File::new(&bytes).unwrap_or_else(|error| panic!("{}", error.in_file(path)));
    let mut dump = Dump { lines: dump.split('\n'), place: String::new() };
    let mut compared = 0;
    for (index, entry) in file.entries().iter().enumerate() {
        dump.place = format!("{}, dataset {index} ({})", path.display(), entry.dataset);
        let title = dump.line();
        let number = entry.dataset;
        if title == format!("dataset {number} read") {
            dump.record(&file.record(index).unwrap_or_else(|error| panic!("{}", error.in_file(path))));
            compared += 1;
        } else {
            assert_eq!(title, format!("dataset {number} unread"));
        }
    }
    compared
}

#[test]
#[ignore = "needs the data of ../shared/data and Python with pyuff"]
fn sample_files_needs_data_and_pyuff() {
    let samples = uff_support::samples();
    let python = outside::python_with("pyuff");
    let files = fs::read_dir(samples).expect("a readable folder").map(|file| file.expect("an entry").path());
    let mut files: Vec<PathBuf> = files.collect();
    files.sort();
    let compared =
        files.iter().zip(dumps(&python, &files)).map(|(file, dump)| compare(file, &dump)).sum::<usize>();
    // All of the typed datasets but five functions at which pyuff stops: the four after whose data a line end
    // stands, and the one whose header holds the characters of a delimiter.
    assert_eq!(compared, 27);
}

#[test]
#[ignore = "needs Python with pyuff"]
fn files_written_here_needs_pyuff() {
    let python = outside::python_with("pyuff");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("uff_written");
    fs::create_dir_all(&folder).expect("a folder for files");
    let forms = [
        ("ascii", Form::Ascii),
        ("little", Form::Binary { endian: Endian::Little }),
        ("big", Form::Binary { endian: Endian::Big }),
    ];
    let mut files = Vec::new();
    for (data_type, spacing) in variants() {
        for (name, form) in forms {
            let bytes = uff::write::function(&function(data_type, spacing, &numbers(data_type)), form);
            let even = if spacing == Spacing::Uneven { "uneven" } else { "even" };
            let file = folder.join(format!("{}-{even}-{name}.uff", data_type.number()));
            fs::write(&file, bytes.expect("a writable function")).expect("a written file");
            files.push(file);
        }
    }
    let rest = folder.join("rest.uff");
    let node = Node { label: 9, color: 11, position: [0.1, -0.25, 1.0 / 3.0], ..Node::default() };
    let datasets = [
        uff::write::file_header(&uff::FileHeader { model: "plate".to_owned(), ..Default::default() }),
        uff::write::units(&Units { length: 1000.0, ..Units::default() }),
        uff::write::nodes_15(&[node, node]),
        uff::write::nodes_2411(&[node, node]),
    ];
    let datasets = datasets.into_iter().collect::<Result<Vec<_>, _>>().expect("writable datasets");
    fs::write(&rest, datasets.concat()).expect("a written file");
    files.push(rest);

    let compared: Vec<usize> =
        files.iter().zip(dumps(&python, &files)).map(|(file, dump)| compare(file, &dump)).collect();
    assert_eq!(compared, [vec![1; 24], vec![4]].concat());
}

/// Numbers of all sizes; 14 of them fill lines of six and of four and begin new ones.
fn numbers(data_type: DataType) -> Vec<f64> {
    let largest = if data_type.is_double() { 1e300 } else { f64::from(f32::MAX) };
    let numbers =
        [0.0, -1.0, 1.0 / 3.0, -2e-3, 7e12, -1e-30, largest, 5.0, -6.0, 2.5, 1e5, -1e-7, 42.0, -0.125];
    if data_type.is_double() {
        numbers.to_vec()
    } else {
        numbers.map(|value| f64::from(value as f32)).to_vec()
    }
}
