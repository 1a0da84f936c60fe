//! Broken tables: each is refused with a word about where and what.

use frfit_formats::FormatError;
use frfit_formats::csv::{Table, read_dof_names, read_frf, read_modulus, read_time_records, read_vector};

/// Checks the exact words for each text.
fn refused<T: std::fmt::Debug>(read: impl Fn(&[u8]) -> Result<T, FormatError>, cases: &[(&[u8], &str)]) {
    for (text, message) in cases {
        let text_shown = text.escape_ascii();
        assert_eq!(read(text).unwrap_err().to_string(), *message, "{text_shown}");
    }
}

#[test]
fn tables_that_are_none_are_refused_with_a_word() {
    refused(
        Table::read,
        &[
            (b"", "input: expected a line with the names of the columns, found none"),
            (b"# nothing\n\n", "input: expected a line with the names of the columns, found none"),
            (b"a,b\n1\n", "input:2: expected 2 cells, found 1"),
            (b"a,b\n1,5,2\n", "input:2: expected 2 cells, found 3 (a decimal comma? write 1.5)"),
            (
                b"a,b\n\"1,2\n",
                "input:2:1: expected a closing quote on the same line, found the end of the line",
            ),
            (b"a,\xe9\n", "input:1:3: expected text in UTF-8, found the byte 0xE9"),
            (
                b"a,b\n1,2\r3,4\n",
                "input:2:4: expected lines that end with LF or CR LF, found a CR inside a line",
            ),
            (b"a\tb\n1\t2\t3\n", "input:2: expected 2 cells, found 3"),
        ],
    );
}

#[test]
fn frequency_responses_are_refused_with_a_word() {
    refused(
        read_frf,
        &[
            (
                b"# decay_per_s = -6\nfrequency_hz,re,im\n1,2,3\n",
                "input:1: expected decay_per_s = a number of 1/s from 0 on, found decay_per_s = -6",
            ),
            (
                b"# decay_per_s = 6\nfrequency_hz,re,im\n#decay_per_s=7\n1,2,3\n",
                "input:3: expected one decay_per_s, found 7 after 6",
            ),
            (
                b"frequency_hz,re,im\n",
                "input:1: expected at least one line of data below the names, found none",
            ),
            (
                b"freqs_hz,re,im\n1,2,3\n",
                "input:1:1: expected one of the columns frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std, found \"freqs_hz\"; did you mean \"frequency_hz\"?",
            ),
            (
                b"frequency_hz,re\n1,2\n",
                "input:1: expected a column \"im\", found only \"frequency_hz\", \"re\"",
            ),
            (
                b"frequency_hz,re,im,coherance\n1,2,3,1\n",
                "input:1:20: expected one of the columns frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std, found \"coherance\"; did you mean \"coherence\"?",
            ),
            (
                b"frequency_hz,re,im,\n1,2,3,\n",
                "input:1:20: expected one of the columns frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std, found a column without a name",
            ),
            (
                b"frequency_hz,re,im,re\n1,2,3,4\n",
                "input:1:20: expected one column such as \"re\", found a second one",
            ),
            (
                b"frequency_hz,re,im\n1,nan,3\n",
                "input:2:3: expected a finite number in column \"re\", found \"nan\"",
            ),
            (
                b"frequency_hz;re;im\n1.5;2;3,5\n",
                "input:2:7: expected a decimal point as in other cells (write 3.5) in column \"im\", found a decimal comma in \"3,5\"",
            ),
            (
                b"frequency_hz,re,im\n1,,3\n",
                "input:2:3: expected a finite number in column \"re\", found an empty cell",
            ),
            (
                b"frequency_hz,re,im\n-1,2,3\n",
                "input:2:1: expected a number from 0 on in column \"frequency_hz\", found \"-1\"",
            ),
            (
                b"frequency_hz,re,im\n1,2,3\n2,2,3\n1.0,2,3\n",
                "input:4:1: expected each frequency once in column \"frequency_hz\", found \"1.0\" again, first in line 2",
            ),
            (
                b"frequency_hz,re,im,coherence\n1,2,3,1.5\n",
                "input:2:7: expected a number from 0 to 1 in column \"coherence\", found \"1.5\"",
            ),
            (
                b"frequency_hz,re,im,std\n1,2,3,-1\n",
                "input:2:7: expected a number from 0 on in column \"std\", found \"-1\"",
            ),
            (b"f,mag\n1,2\n", "input:1: expected a column \"phase_deg\", found only \"f\", \"mag\""),
            (
                b"f,re,phase_deg\n1,2,3\n",
                "input:1: expected re and im, or a magnitude and a phase, found \"f\", \"re\", \"phase_deg\"",
            ),
            (
                b"f,mag,phase\n1,2,3\n",
                "input:1:7: expected the unit of the phase, as in phase_deg or \"phase (rad)\", found \"phase\"",
            ),
            (
                b"f,mag,mag_db,phase_deg\n1,2,3,4\n",
                "input:1:7: expected one column such as \"mag\", found a second one",
            ),
            (
                b"f,mag (mm/N),phase_deg\n1,2,3\n",
                "input:1:3: expected values in m, s, N and kg (scale of [[measurement]] has the factor), found \"mag (mm/N)\"",
            ),
            (
                b"f (rpm),re,im\n1,2,3\n",
                "input:1:1: expected a frequency in Hz, kHz or rad/s, found \"f (rpm)\"",
            ),
            (
                b"f,mag,phase_deg\n1,-2,3\n",
                "input:2:3: expected a number from 0 on in column \"mag\", found \"-2\"",
            ),
            (
                b"frequency_hz,re,im\nHz,m/N,m/N\n",
                "input:2:1: expected a finite number in column \"frequency_hz\", found \"Hz\"",
            ),
            (
                b"frequency_hz,re,im\n1,5,2,5,3,5\n",
                "input:2: expected 3 cells, found 6 (a decimal comma? write 1.5)",
            ),
            (
                b"\xc3\xa9,re,im\n",
                "input:1:1: expected one of the columns frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std, found \"é\"",
            ),
        ],
    );
}

#[test]
fn vectors_are_refused_with_a_word() {
    refused(
        read_vector,
        &[
            (b"row,re\n0,1\n", "input:2:1: expected a whole number from 1 on in column \"row\", found \"0\""),
            (
                b"row,re\n1.5,1\n",
                "input:2:1: expected a whole number from 1 on in column \"row\", found \"1.5\"",
            ),
            (
                b"row,re\n3,1\n 3,2\n",
                "input:3:2: expected each row once in column \"row\", found \"3\" again, first in line 2",
            ),
            (
                b"row,imag,re\n1,2,3\n",
                "input:1:5: expected one of the columns row, re, im, found \"imag\"; did you mean \"im\"?",
            ),
            (
                b"rows,re\n1,2\n",
                "input:1:1: expected one of the columns row, re, im, found \"rows\"; did you mean \"row\"?",
            ),
            (b"row,re\n", "input:1: expected at least one line of data below the names, found none"),
        ],
    );
}

#[test]
fn dof_names_are_refused_with_a_word() {
    refused(
        read_dof_names,
        &[
            (
                b"row,node,direction\n1,1,W\n",
                "input:2:5: expected X, Y, Z, RX, RY or RZ in column \"direction\", found \"W\"",
            ),
            (
                b"row,node,direction\n1,1,X\n1,2,X\n",
                "input:3:1: expected each row once in column \"row\", found \"1\" again, first in line 2",
            ),
            (
                b"row,node,direction\n1,1,X\n2,1,x\n",
                "input:3:3: expected each node and direction once in column \"node\", found \"1\" again, first in line 2",
            ),
            (
                b"row,node,direction\n1,-4,X\n",
                "input:2:3: expected a whole number from 0 on in column \"node\", found \"-4\"",
            ),
            (
                b"row,node,direction\n1,18446744073709551615,X\n",
                "input:2:3: expected a node number below 2^63 in column \"node\", found \"18446744073709551615\"",
            ),
            (
                b"row,node,dir\n1,1,X\n",
                "input:1:10: expected one of the columns row, node, direction, found \"dir\"; did you mean \"direction\"?",
            ),
        ],
    );
}

#[test]
fn moduli_are_refused_with_a_word() {
    refused(
        read_modulus,
        &[
            (
                b"frequency_hz,storage\n1,2\n",
                "input:1: expected a column \"loss_factor\", found only \"frequency_hz\", \"storage\"",
            ),
            (
                b"frequency_hz,storage,loss,loss_factor\n1,2,3,4\n",
                "input:1:22: expected one of the columns loss_factor and loss, found a second one",
            ),
            (
                b"frequency_hz,storage,loss\n1,,\n",
                "input:1: expected at least one line with a modulus below the names, found none",
            ),
            (
                b"frequency_hz,storage,loss\n1,2,\n",
                "input:2:5: expected a finite number in column \"loss\", found an empty cell",
            ),
            (
                b"frequency_hz,storage,loss_factor\n1,1e300,1e300\n",
                "input:2:9: expected a finite storage * loss_factor in column \"loss_factor\", found inf",
            ),
            (
                b"f, E_stor, E_loss\nHz,MPa,MPa\n",
                "input:1: expected a column \"frequency_hz\", found only \"f\", \"E_stor\", \"E_loss\"",
            ),
        ],
    );
}

#[test]
fn time_records_are_refused_with_a_word() {
    refused(
        read_time_records,
        &[
            (b"x,force\n0,1\n", "input:1: expected a column \"time_s\", found \"x\", \"force\""),
            (b"time (ms),force\n0,1\n", "input:1:1: expected a time in s, found \"ms\""),
            (b"t\n0\n", "input:1: expected at least one column beside the time, found none"),
            (b"t,f\n", "input:1: expected at least one line of data below the names, found none"),
            (
                b"t,f\n0,1\n1,1\n1,1\n",
                "input:4:1: expected ascending instants in column \"t\", found 1 after 1",
            ),
            (b"t,f\n0,\n", "input:2:3: expected a finite number in column \"f\", found an empty cell"),
        ],
    );
}
