//! Broken files: each is refused with a word about where and what.

use frfit_formats::lvm::read;

fn refused(text: &str, message: &str) {
    assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
}

/// A file of one channel with these lines in its segment.
fn file(header: &str, segment: &str, rows: &str) -> String {
    format!(
        "LabVIEW Measurement\n{header}***End_of_Header***\n\n{segment}***End_of_Header***\nX_Value\tForce\tComment\n{rows}"
    )
}

const SEGMENT: &str = "Channels\t1\nDelta_X\t1\n";

#[test]
fn files_that_are_none() {
    refused("", "input:1: expected \"LabVIEW Measurement\" in the first line, found something else");
    refused(
        "LabVIEW Measurement\nSeparator\tTab\n",
        "input:2: expected ***End_of_Header***, found the end of the file",
    );
    refused(
        "LabVIEW Measurement\n***End_of_Header***\n\n",
        "input: expected a segment with channels, found the file's header alone",
    );
    refused(
        "LabVIEW Measurement\n***End_of_Header***\nChannels\t1\n",
        "input:3: expected ***End_of_Header*** of a segment, found the end of the file",
    );
}

#[test]
fn headers() {
    refused(
        &file("Separator;Semicolon\n", SEGMENT, ""),
        "input:2:10: expected a tab and Tab, or a comma and Comma, found \";Semicolon\"",
    );
    refused(
        &file("Decimal_Separator\t;\n", SEGMENT, ""),
        "input:2:19: expected a decimal point or a decimal comma, found \";\"",
    );
    refused(
        "LabVIEW Measurement\nSeparator,Comma\nDecimal_Separator,,\n***End_of_Header***\n",
        "input:4: expected different signs for columns and decimals, found a comma for both",
    );
    refused(&file("X_Columns\tTwo\n", SEGMENT, ""), "input:2:11: expected No, One or Multi, found \"Two\"");
    refused(&file("Operator\n", SEGMENT, ""), "input:2: expected a key and its value, found \"Operator\"");
    refused(
        &file("", "Delta_X\t1\n", ""),
        "input:5: expected the number of Channels of a segment, found a header without it in line 4",
    );
    refused(
        &file("", "Channels\t3\nDelta_X\t1\n", ""),
        "input:4:10: expected 1 to 2 channels, as many as there are names below, found \"3\"",
    );
    refused(
        &file("", "Channels\t1\n", ""),
        "input:6: expected a Delta_X for each channel, as there is no column of X, found none for \"Force\"",
    );
    refused(&file("", "Channels\t1\nDelta_X\t0\n", ""), "input:5:9: expected a Delta_X above 0, found \"0\"");
    refused(
        "LabVIEW Measurement\n***End_of_Header***\nChannels\t1\n***End_of_Header***\n\t1\n",
        "input:5: expected a line X_Value with the names of the columns, found \"\\t1\"",
    );
}

#[test]
fn rows() {
    let in_rows = |rows: &str| file("", SEGMENT, rows);
    refused(&in_rows("\t1,5\n"), "input:8:2: expected a finite number with a decimal point, found \"1,5\"");
    refused(&in_rows("\tNaN\n"), "input:8:2: expected a finite number with a decimal point, found \"NaN\"");
    refused(
        &file("Decimal_Separator\t,\n", SEGMENT, "\t1.5\n"),
        "input:9:2: expected a finite number with a decimal comma, found \"1.5\"",
    );
    refused(&in_rows("0.5\t1\n"), "input:8:1: expected an empty column, as X_Columns is No, found \"0.5\"");
    refused(
        &in_rows("\t1\t\t7\n"),
        "input:8:5: expected the end of the row after all channels and a comment, found \"7\"",
    );
    refused(
        &file("", "Channels\t2\nDelta_X\t1\t1\n", "\t1\n\t2\t3\n"),
        "input:9:4: expected an empty column, as in the rows above, found \"3\"",
    );
    refused(
        &file("", "Channels\t1\nSamples\t3\nDelta_X\t1\n", "\t1\n\t2\n"),
        "input:4: expected 3 samples of \"Force\", as the header says, found 2",
    );
}
