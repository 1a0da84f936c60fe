//! The reader.

use num_complex::Complex64 as c64;
use std::collections::HashMap;

use super::card::{Field, Piece, each_piece};
use super::header::{Form, Header, is_header, label, name, real};
use crate::labelled::{Labelled, index_of, shown_label, sorted};
use crate::{DofLabel, FormatError, Labels, NamedMatrix, Symmetry};

/// Reads all matrices of a punch file or of bulk data, in the order of their headers.
///
/// # Errors
/// A header that says what there is not; two headers of one name; a card of a matrix without a header; a field that is not
/// what is due there; no matrix, or more than a thousand. What is wrong with one matrix as a whole (an entry given twice or in both triangles of a
/// symmetric one, a column beyond NCOL) is reported in place of that matrix: the others can be read.
pub fn read(bytes: &[u8]) -> Result<Vec<NamedMatrix>, FormatError> {
    let headers = headers(bytes)?;
    let index: HashMap<&str, usize> = headers.iter().enumerate().map(|(k, h)| (h.name.as_str(), k)).collect();
    let mut all: Vec<_> = headers.iter().map(|_| Labelled::new()).collect();
    let mut column = None;
    each_piece(bytes, |piece| {
        match piece {
            Piece::Head(head) if is_header(&head) => column = None,
            Piece::Head(head) => {
                let name = name(&head[0])?;
                let Some(&k) = index.get(name.as_str()) else {
                    return Err(head[0].refuse("a matrix that has a header"));
                };
                column = Some((k, label(&head[1], &head[2])?));
                if !head[3].is_blank() {
                    return Err(head[3].refuse("a blank field after the component of the column"));
                }
                take_entry(&headers, &mut all, column, [head[4], head[5], head[6], head[7]])?;
            }
            Piece::Entry(fields) => take_entry(&headers, &mut all, column, fields)?,
        }
        Ok(())
    })?;
    Ok(headers.iter().zip(all).map(|(header, entries)| matrix(header, entries)).collect())
}

/// More are in no file that is meant; each takes room before its first entry.
const MAX_MATRICES: usize = 1000;

fn headers(bytes: &[u8]) -> Result<Vec<Header>, FormatError> {
    let mut headers: Vec<Header> = Vec::new();
    let mut lines = HashMap::new();
    each_piece(bytes, |piece| {
        if let Piece::Head(head) = piece
            && is_header(&head)
        {
            let header = Header::read(&head)?;
            if let Some(first) = lines.insert(header.name.clone(), header.line) {
                let found = format!("{} again, first in line {first}", header.name);
                return Err(FormatError::line(header.line, "one header for each matrix", found));
            }
            if headers.len() == MAX_MATRICES {
                let expected = format!("at most {MAX_MATRICES} matrices in a file");
                return Err(FormatError::line(header.line, expected, "one more"));
            }
            headers.push(header);
        }
        Ok(())
    })?;
    match headers.is_empty() {
        true => Err(FormatError::whole("the header of a matrix: DMIG, its name, 0", "none")),
        false => Ok(headers),
    }
}

/// Adds grid, component and value to a column; four blank fields hold no entry.
fn take_entry(
    headers: &[Header],
    all: &mut [Labelled<i64>],
    column: Option<(usize, DofLabel)>,
    [grid, component, first, second]: [Field<'_>; 4],
) -> Result<(), FormatError> {
    if [&grid, &component, &first, &second].into_iter().all(Field::is_blank) {
        return Ok(());
    }
    let Some((k, column)) = column else {
        return Err(grid.refuse("no more fields behind a header"));
    };
    let (header, entries) = (&headers[k], &mut all[k]);
    let (row, line) = (label(&grid, &component)?.code(), grid.line.number);
    match (header.is_complex, header.is_polar) {
        (false, _) => {
            if !second.is_blank() && real(&second)? != 0.0 {
                return Err(second.refuse("no imaginary part in a real matrix"));
            }
            entries.push(line, row, column.code(), real(&first)?);
        }
        (true, is_polar) => {
            // A part that is blank is zero, as in all bulk data.
            let part = |field: &Field<'_>| if field.is_blank() { Ok(0.0) } else { real(field) };
            let (a, b) = (part(&first)?, part(&second)?);
            let value = if is_polar { c64::from_polar(a, b.to_radians()) } else { c64::new(a, b) };
            if !value.is_finite() {
                return Err(first.refuse("a finite value"));
            }
            entries.push_complex(line, row, column.code(), value);
        }
    }
    Ok(())
}

/// What has come together of one matrix.
fn matrix(header: &Header, entries: Labelled<i64>) -> NamedMatrix {
    let made = match header.form {
        Form::Square => entries.square(Symmetry::General, header.name.clone()),
        Form::Symmetric => entries.square(Symmetry::Symmetric, header.name.clone()),
        Form::Rectangular(columns) => return rectangular(header, entries, columns),
    };
    let (matrix, rows) = match made {
        Ok((matrix, rows)) => (Ok(matrix), rows),
        Err(error) => (Err(error), Vec::new()),
    };
    NamedMatrix { name: header.name.clone(), matrix, labels: Labels::of_rows(rows) }
}

fn rectangular(header: &Header, entries: Labelled<i64>, columns: Option<u64>) -> NamedMatrix {
    let name = header.name.clone();
    let rows = sorted(entries.rows().to_vec());
    let cols = sorted(entries.cols().to_vec());
    let of_codes = |codes: &[i64]| codes.iter().copied().map(DofLabel::of_code).collect::<Vec<_>>();
    let row_of = (rows.len(), index_of(&rows));
    let (matrix, labels) = match columns {
        None => {
            let col_of = (cols.len(), index_of(&cols));
            let labels = Labels { columns: of_codes(&cols), ..Labels::of_rows(of_codes(&rows)) };
            (entries.assemble(Symmetry::General, row_of, col_of, shown_label, name.clone()), labels)
        }
        Some(ncols) => {
            let last = cols.last().map_or(0, |&code| DofLabel::of_code(code).node as u64);
            let labels = Labels::of_rows(of_codes(&rows));
            if last > ncols {
                let expected = format!("columns up to NCOL = {ncols}");
                let error = FormatError::line(header.line, expected, format!("column {last}"));
                return NamedMatrix { name, matrix: Err(error), labels };
            }
            let col_of = (ncols as usize, |code| DofLabel::of_code(code).node as u64 - 1);
            (entries.assemble(Symmetry::General, row_of, col_of, shown_label, name.clone()), labels)
        }
    };
    NamedMatrix { name, matrix, labels }
}
