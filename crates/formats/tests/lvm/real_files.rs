//! Hammer tests as LabVIEW recorded them.

use crate::outside::{python_with, shared};
use frfit_formats::lvm::{Abscissa, DecimalSign, Lvm, read};
use std::process::Command;

fn samples(file: &Lvm) -> Vec<usize> {
    file.segments.iter().flat_map(|segment| &segment.channels).map(|channel| channel.values.len()).collect()
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn five_hits_needs_data() {
    let path = shared("hammer/impact2_response0.lvm");
    let file = read(&std::fs::read(path).unwrap()).unwrap();
    assert_eq!(samples(&file), [51200; 10]);
    let first = &file.segments[0];
    let units: Vec<&str> = first.channels.iter().map(|channel| channel.unit.as_str()).collect();
    assert_eq!(units, ["Newtons", "m/s^2"]);
    assert_eq!(first.channels[0].abscissa, Abscissa::Even { start: 0.0, step: 1.953125e-5 });
    // As in line 79 of the file: the spike.
    assert_eq!(first.channels[0].values[55], 2000.067121);
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn a_decimal_comma_needs_data() {
    let path = shared("hammer/acceleration.lvm");
    let file = read(&std::fs::read(path).unwrap()).unwrap();
    assert_eq!((file.decimal, samples(&file)), (DecimalSign::Comma, vec![50030; 2]));
    let [acceleration, force] = &file.segments[0].channels[..] else { panic!("two channels") };
    assert_eq!((acceleration.unit.as_str(), force.unit.as_str()), ("g", "Newtons"));
    assert_eq!((acceleration.values[1], force.values[0]), (-0.016783, 0.232147));
}

const SCRIPT: &str = "
import sys, lvm_read
data = lvm_read.read(sys.argv[1], read_from_pickle=False, dump_file=False)
for k in range(data['Segments']):
    for column in data[k]['data'].T:
        print(len(column), column.sum().hex(), float((column * column).sum()).hex(), column[-1].hex())
";

/// Sums over all samples of a channel show a sample that is lost, doubled or misread.
#[test]
#[ignore = "needs the data of ../shared/data and Python with lvm_read"]
fn lvm_read_reads_the_same_needs_data_and_lvm_read() {
    let python = python_with("lvm_read");
    for name in ["hammer/impact2_response0.lvm", "hammer/acceleration.lvm"] {
        let path = shared(name);
        let output = Command::new(&python).args(["-c", SCRIPT]).arg(&path).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let theirs = String::from_utf8(output.stdout).unwrap();
        let file = read(&std::fs::read(path).unwrap()).unwrap();
        let channels: Vec<_> = file.segments.iter().flat_map(|segment| &segment.channels).collect();
        assert_eq!(theirs.lines().count(), channels.len());
        for (line, channel) in theirs.lines().zip(channels) {
            let words: Vec<&str> = line.split(' ').collect();
            let [sum, squares, last] = [1, 2, 3].map(|k| hexadecimal(words[k]));
            assert_eq!(words[0], channel.values.len().to_string());
            assert_eq!(*channel.values.last().unwrap(), last);
            // NumPy sums pairwise: the roundoff of 5e4 sums in sequence is 1e-12 of the largest.
            let near = |ours: f64, theirs: f64, size: f64| (ours - theirs).abs() <= 1e-11 * size;
            let size: f64 = channel.values.iter().map(|x| x.abs()).sum();
            assert!(near(channel.values.iter().sum(), sum, size));
            assert!(near(channel.values.iter().map(|x| x * x).sum(), squares, squares));
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
