//! What is written is read back equal.

use frfit_formats::lvm::{Abscissa, Channel, DecimalSign, Lvm, Segment, Separator, read, write};
use proptest::collection::vec;
use proptest::prelude::*;

/// Numbers of every size, subnormal ones among them.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>().prop_filter("finite", |x| x.is_finite()), -1e3..1e3]
}

/// Names and units with everything that has no meaning in the format.
fn text() -> impl Strategy<Value = String> {
    "[a-zX_é(]([a-z .;#é²)/]{0,8}[a-z)])?"
}

fn channel(listed: bool) -> impl Strategy<Value = Channel> {
    (text(), text(), vec((number(), number()), 1..6), number(), 1e-9..1e3).prop_map(
        move |(name, unit, points, start, step)| {
            let (x, values) = points.into_iter().unzip();
            let abscissa = if listed { Abscissa::Listed(x) } else { Abscissa::Even { start, step } };
            Channel { name, unit, abscissa, values }
        },
    )
}

fn file() -> impl Strategy<Value = Lvm> {
    let segment = |listed| {
        (text(), text(), vec(channel(listed), 1..4)).prop_map(|(date, time, channels)| Segment {
            line: 0,
            date,
            time,
            channels,
        })
    };
    let signs = prop_oneof![
        Just((Separator::Tab, DecimalSign::Point)),
        Just((Separator::Tab, DecimalSign::Comma)),
        Just((Separator::Comma, DecimalSign::Point)),
    ];
    let segments = any::<bool>().prop_flat_map(move |listed| vec(segment(listed), 1..4));
    (signs, vec((text(), text()), 0..3), segments).prop_map(|((separator, decimal), header, segments)| Lvm {
        separator,
        decimal,
        header,
        segments,
    })
}

proptest! {
    #[test]
    fn files_come_back(file in file()) {
        let mut read = read(write(&file).unwrap().as_bytes()).unwrap();
        read.segments.iter_mut().for_each(|segment| segment.line = 0);
        read.header.retain(|(key, _)| !["Writer_Version", "Reader_Version", "Multi_Headings"].contains(&key.as_str()));
        prop_assert_eq!(read, file);
    }

    #[test]
    fn no_bytes_are_too_much(bytes in vec(any::<u8>(), 0..200), cut in 0_usize..400) {
        let _ = read(&bytes);
        let good = b"LabVIEW Measurement\nX_Columns\tOne\n***End_of_Header***\n\nChannels\t1\nDelta_X\t1\n***End_of_Header***\nX_Value\ta\n0\t1\n";
        let mut broken = good[..cut.min(good.len())].to_vec();
        broken.extend(&bytes);
        let _ = read(&broken);
    }
}

#[test]
fn what_would_not_come_back_is_not_written() {
    let channel = Channel {
        name: "Force".into(),
        unit: "N".into(),
        abscissa: Abscissa::Even { start: 0.0, step: 1.0 },
        values: vec![1.0],
    };
    let of = |channels| Lvm { segments: vec![Segment { channels, ..Segment::default() }], ..Lvm::default() };
    assert!(write(&of(vec![channel.clone()])).is_ok());
    let step = |step| Channel { abscissa: Abscissa::Even { start: 0.0, step }, ..channel.clone() };
    let listed = |x| Channel { abscissa: Abscissa::Listed(x), ..channel.clone() };
    let broken = [
        Lvm::default(),
        of(vec![]),
        of(vec![Channel { name: "a\tb".into(), ..channel.clone() }]),
        of(vec![Channel { unit: " N".into(), ..channel.clone() }]),
        of(vec![Channel { values: vec![f64::NAN], ..channel.clone() }]),
        of(vec![step(0.0)]),
        of(vec![step(f64::NAN)]),
        of(vec![listed(vec![])]),
        of(vec![channel.clone(), listed(vec![1.0])]),
        Lvm { separator: Separator::Comma, decimal: DecimalSign::Comma, ..of(vec![channel.clone()]) },
        Lvm { header: vec![("Separator".into(), "Tab".into())], ..of(vec![channel.clone()]) },
    ];
    for file in broken {
        assert!(write(&file).is_err(), "{file:?}");
    }
}
