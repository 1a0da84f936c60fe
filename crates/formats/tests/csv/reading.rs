//! Tables as spreadsheets and scripts write them.

use frfit_formats::csv::{
    Cell, Direction, Table, read_dof_names, read_frf, read_frf_named, read_modulus, read_time_records,
    read_vector, write,
};
use num_complex::Complex64 as c64;
use std::f64::consts::PI;

#[test]
fn delimiters_quotes_comments_and_line_ends_do_not_matter() {
    for text in [
        "a,b\n1,x y\n2,\n",
        "\u{feff}a;b\r\n1;x y\r\n2;\r\n",
        "# made by hand\n\n a\t b \n 1 \t\"x y\"\n# between\n\n2\t",
        "\"a\",\"b\"\n\"1\",x y\n2,\"\"\n",
    ] {
        let table = Table::read(text.as_bytes()).unwrap();
        assert_eq!(table.names().collect::<Vec<_>>(), ["a", "b"], "{text:?}");
        assert_eq!(table.rows(), 2);
        assert_eq!([table.text(0, 0), table.text(0, 1)], ["1", "x y"]);
        assert_eq!((table.number(1, 0), table.is_empty(1, 1)), (Ok(2.0), true));
        assert_eq!(table.text(5, 0), "");
        assert_eq!(table.text(0, 5), "");
    }
}

#[test]
fn quoted_cells_keep_delimiters_quotes_and_blanks() {
    let table = Table::read(b"\"a;b\",\" c \"\n\"say \"\"x\"\"\",#1\n").unwrap();
    assert_eq!(table.names().collect::<Vec<_>>(), ["a;b", " c "]);
    assert_eq!([table.text(0, 0), table.text(0, 1)], ["say \"x\"", "#1"]);
}

#[test]
fn an_frf_is_sorted_and_carries_its_quality() {
    let frf = read_frf(b"IM;re;frequency_hz;coherence\n-2;1;20;0.5\n0;1e-3;10;1\n").unwrap();
    assert_eq!(frf.frequency_hz, [10.0, 20.0]);
    assert_eq!(frf.response, [c64::new(1e-3, 0.0), c64::new(1.0, -2.0)]);
    assert_eq!((frf.coherence, frf.std, frf.decay_per_s), (Some(vec![1.0, 0.5]), None, None));
}

/// 3 + 4i and −2i at 10 and 1000 Hz, however it is written.
#[test]
fn the_same_frf_in_other_columns_units_and_signs() {
    let (first, second) = ((4.0_f64).atan2(3.0), -90.0);
    let (deg, db) = (first.to_degrees(), 20.0 * 5.0_f64.log10());
    let db2 = 20.0 * 2.0_f64.log10();
    for text in [
        format!("f,mag,phase_deg\n10,5,{deg}\n1000,2,{second}\n"),
        format!("Phase (deg);Magnitude [m/N];Frequency (kHz)\n{deg};5;0.01\n{second};2;1\n"),
        format!(
            "frequency (rad/s)\tAmplitude (dB)\tphase [rad]\n{}\t{db}\t{first}\n{}\t{db2}\t{}\n",
            20.0 * PI,
            2000.0 * PI,
            -PI / 2.0
        ),
        "freq,Real part,Imaginary\n1e3,0,-2\n10,3,4\n".to_owned(),
        "Freq [Hz];real;imag\n10,0;3,0;4,00\n1000;0;-2,0E0\n".to_owned(),
        "frequency_khz;magnitude_db;angle_rad\n".to_owned()
            + &format!("0,01;{db};{first}\n1,0;{db2};{}\n", -PI / 2.0).replace('.', ","),
    ] {
        near(&read_frf(text.as_bytes()).unwrap(), &text);
    }
}

/// Names that the caller gives stand in place of those of the table, or where it has none.
#[test]
fn columns_that_the_caller_names() {
    let names = ["frequency_hz", "-", "magnitude", "phase_deg"];
    let deg = (4.0_f64).atan2(3.0).to_degrees();
    for head in ["", "Hz;counts;amp;ph\n", "# a comment\n1st;2nd;3rd;4th\n"] {
        let text = format!("{head}10;7;5,0;{}\n1000;8;2;-90,0\n", deg.to_string().replace('.', ","));
        near(&read_frf_named(text.as_bytes(), &names).unwrap(), &text);
    }
    let refused = read_frf_named(b"10,3,4\n", &names).unwrap_err();
    assert_eq!(refused.to_string(), "input:1: expected 4 columns, one for each name, found 3");
}

fn near(frf: &frfit_formats::csv::FrfTable, text: &str) {
    let expected = [c64::new(3.0, 4.0), c64::new(0.0, -2.0)];
    let off = frf.response.iter().zip(expected).map(|(value, expected)| (value - expected).norm());
    assert!(off.fold(0.0, f64::max) < 1e-14, "{text}{:?}", frf.response);
    let hertz = frf.frequency_hz.iter().zip([10.0, 1000.0]).map(|(f, expected)| (f / expected - 1.0).abs());
    assert!(hertz.fold(0.0, f64::max) < 1e-15, "{text}{:?}", frf.frequency_hz);
}

#[test]
fn a_comment_line_says_how_an_frf_was_windowed() {
    for head in ["# decay_per_s = 6.25", "  #decay_per_s=6.25\r", "# by hand\n# decay_per_s  =  625e-2 \n\n#"]
    {
        let frf = read_frf(format!("{head}\nfrequency_hz,re,im\n1,2,3\n").as_bytes()).unwrap();
        assert_eq!(frf.decay_per_s, Some(6.25), "{head:?}");
    }
    // Other words are comments.
    let frf = read_frf(b"# decay_per_second = 6\n# decay_per_s of the window\nfrequency_hz,re,im\n1,2,3\n");
    assert_eq!(frf.unwrap().decay_per_s, None);
}

#[test]
fn a_vector_may_be_real() {
    let expected = vec![(7, c64::new(1.0, 0.0)), (2, c64::new(-1.5, 0.0))];
    assert_eq!(read_vector(b"row,re\n7,1\n2,-1.5\n"), Ok(expected));
    assert_eq!(read_vector(b"im,row,re\n2,1,3\n"), Ok(vec![(1, c64::new(3.0, 2.0))]));
}

#[test]
fn dof_names_have_a_direction() {
    let names = read_dof_names(b"row,node,direction\n2,12,z\n1,12,RX\n").unwrap();
    assert_eq!(names.iter().map(|n| (n.row, n.node)).collect::<Vec<_>>(), [(2, 12), (1, 12)]);
    assert_eq!([names[0].direction, names[1].direction], [Direction::Z, Direction::Rx]);
    assert_eq!(names[1].direction.number(), 4);
}

#[test]
fn a_modulus_has_a_loss_factor_or_a_loss_and_may_have_gaps() {
    let by_factor =
        read_modulus(b"frequency_hz,storage,loss_factor,status\n20,,,diverged\n10,4e6,0.5,ok\n").unwrap();
    let by_loss = read_modulus(b"frequency_hz,loss,storage\n10,2e6,4e6\n").unwrap();
    assert_eq!(by_factor, by_loss);
    assert_eq!((by_loss.frequency_hz, by_loss.modulus), (vec![10.0], vec![c64::new(4e6, 2e6)]));
}

#[test]
fn time_records_have_units_in_their_names() {
    let of = |text: &str| read_time_records(text.as_bytes()).unwrap();
    let table = of("Force (N);time [s];a\n1;0;2\n3;0.5;4\n");
    assert_eq!(table.time_s, [0.0, 0.5]);
    let channels: Vec<_> =
        table.channels.iter().map(|c| (c.name.as_str(), c.unit.as_str(), &c.values[..])).collect();
    assert_eq!(channels, [("Force", "N", &[1.0, 3.0][..]), ("a", "", &[2.0, 4.0])]);
    assert_eq!(of("time_s,Signal (1) [m/s^2]\n0,1\n").channels[0].name, "Signal (1)");
}

#[test]
fn missing_numbers_are_written_as_empty_cells() {
    let rows: [[Cell<'_>; 3]; 2] =
        [[1.5.into(), None.into(), "a,b".into()], [f64::NAN.into(), Some(1e-300).into(), "ok".into()]];
    assert_eq!(write(&["f", "x", "status"], rows).unwrap(), "f,x,status\n1.5,,\"a,b\"\n,1e-300,ok\n");
    let rows: [[Cell<'_>; 1]; 1] = [[1.0.into()]];
    let error = write(&["f", "x"], rows).unwrap_err();
    assert_eq!(error.to_string(), "input:2: expected 2 cells in each row, found 1");
    assert!(write(&["two\nlines"], [[Cell::Empty]]).is_err());
    assert!(write(&[], [[Cell::Empty]]).is_err());
}
