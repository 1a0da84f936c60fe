//! Files as LabVIEW writes them.

use frfit_formats::lvm::{Abscissa, DecimalSign, Separator, read};
use frfit_formats::{FileKind, detect};

/// Two segments of two channels; the second channel of the second segment ends early, one row has a comment.
fn text(separator: &str, decimal: &str) -> String {
    let name = if separator == "\t" { "Tab" } else { "Comma" };
    let segment = |x0: &str, rows: &[&str]| {
        format!(
            "|\nChannels|2||\nSamples|2|1\nDate|2019/03/11|2019/03/11\nTime|08:42:44@6|08:42:44@6\n\
             Y_Unit_Label|Newtons|m/s^2\nX_Dimension|Time|Time\nX0|{x0}|{x0}\nDelta_X|2@5E-2|2@5E-2\n\
             ***End_of_Header***||\nX_Value|Force (Trigger)|Acceleration|Comment\n{}\n",
            rows.join("\n")
        )
    };
    let header = format!(
        "LabVIEW Measurement|\nWriter_Version|2\nSeparator|{name}\nDecimal_Separator|@\nMulti_Headings|Yes\n\
         X_Columns|No\nOperator|someone\n***End_of_Header***|\n"
    );
    let first = segment("0@0", &["|-0@5|1E+0", "|1@25|-2@0"]);
    let second = segment("3@5", &["|7|8|the second hit", "|9"]);
    format!("{header}{first}{second}").replace('|', separator).replace('@', decimal)
}

#[test]
fn signs_and_line_ends_do_not_matter() {
    for (separator, decimal) in [("\t", "."), ("\t", ","), (",", ".")] {
        for end in ["\n", "\r\n"] {
            let text = text(separator, decimal).replace('\n', end);
            assert_eq!(detect(text.as_bytes()), Some(FileKind::Lvm));
            let file = read(text.as_bytes()).unwrap();
            assert_eq!(file.separator == Separator::Comma, separator == ",");
            assert_eq!(file.decimal == DecimalSign::Comma, decimal == ",");
            assert!(file.header.contains(&("Operator".to_owned(), "someone".to_owned())));
            let [first, second] = &file.segments[..] else { panic!("{file:?}") };
            assert_eq!((first.date.as_str(), first.line, second.line), ("2019/03/11", 10, 23));
            let [force, acceleration] = &first.channels[..] else { panic!("{first:?}") };
            assert_eq!((force.name.as_str(), force.unit.as_str()), ("Force (Trigger)", "Newtons"));
            assert_eq!((acceleration.name.as_str(), acceleration.unit.as_str()), ("Acceleration", "m/s^2"));
            assert_eq!([&force.values[..], &acceleration.values[..]], [[-0.5, 1.25], [1.0, -2.0]]);
            assert_eq!(force.abscissa, Abscissa::Even { start: 0.0, step: 0.025 });
            assert_eq!(second.channels[0].abscissa, Abscissa::Even { start: 3.5, step: 0.025 });
            assert_eq!(
                [&second.channels[0].values[..], &second.channels[1].values[..]],
                [&[7.0, 9.0][..], &[8.0]]
            );
        }
    }
}

#[test]
fn one_column_of_x_serves_all_channels_and_several_one_each() {
    let header = |columns| format!("LabVIEW Measurement\nX_Columns\t{columns}\n***End_of_Header***\n\n");
    let one =
        header("One") + "Channels\t2\n***End_of_Header***\nX_Value\ta\tb\tComment\n0\t1\t2\n0.5\t3\t4\n";
    let multi = header("Multi")
        + "Channels\t2\n***End_of_Header***\nX_Value\ta\tX_Value\tb\tComment\n0\t1\t0\t2\n0.5\t3\t0.25\t4\n";
    for (text, second) in [(one, 0.5), (multi, 0.25)] {
        let channels = read(text.as_bytes()).unwrap().segments.remove(0).channels;
        assert_eq!(channels[0].abscissa, Abscissa::Listed(vec![0.0, 0.5]));
        assert_eq!(channels[1].abscissa, Abscissa::Listed(vec![0.0, second]));
        assert_eq!((&channels[0].values, &channels[1].values), (&vec![1.0, 3.0], &vec![2.0, 4.0]));
    }
}

#[test]
fn special_blocks_belong_to_the_program_that_wrote_them() {
    let text = "LabVIEW Measurement\n***End_of_Header***\n\n***Start_Special***\nChannels\t9\n***End_of_Header***\n\
                ***End_Special***\nChannels\t1\nDelta_X\t1\n***End_of_Header***\nX_Value\ta\n\t1\n";
    assert_eq!(read(text.as_bytes()).unwrap().segments[0].channels[0].values, [1.0]);
}
