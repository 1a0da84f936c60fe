//! Broken files: each is refused with a word about where and what.

use frfit_formats::{abaqus, ansys, dmig, triplets};

#[test]
fn broken_lists_are_refused_with_a_word() {
    for (text, message) in [
        ("", "input: expected entries: row, column and value, found none"),
        ("** only a comment\n", "input: expected entries: row, column and value, found none"),
        ("0 1 1.0\n", "input:1:1: expected a row from 1 to 2147483647, found \"0\""),
        ("1 x 1.0\n", "input:1:3: expected a column from 1 to 2147483647, found \"x\""),
        ("1 1 nan\n", "input:1:5: expected a finite number, found \"nan\""),
        ("1 1\n", "input:1:4: expected a finite number, found the end of the line"),
        ("1 1 1.0\n2 2 30\n", "input:2:5: expected a value with a decimal point, found \"30\""),
        ("1 1 1.0 7\n", "input:1:9: expected the end of the line, found \"7\""),
        ("2 1 1.0\n1 1 1.0\n2 1 3.0\n", "input:3: expected each position once, found (2, 1) again"),
    ] {
        assert_eq!(triplets::read(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
    }
    for (text, message) in [
        ("", "input: expected names of rows such as 712.1, found none"),
        ("1.1\n12\n", "input:2:1: expected a node, a point and a direction such as 712.1, found \"12\""),
        ("1.12\n", "input:1:1: expected a node, a point and a direction such as 712.1, found \"1.12\""),
        ("0.1\n", "input:1:1: expected a node, a point and a direction such as 712.1, found \"0.1\""),
        ("1.1 2\n", "input:1:5: expected the end of the line, found \"2\""),
        ("1.1\n1.2\n\n1.1\n", "input:4: expected each name once, found 1+X again, first in line 1"),
    ] {
        assert_eq!(triplets::read_dofs(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
    }
}

#[test]
fn broken_abaqus_matrices_are_refused_with_a_word() {
    for (text, message) in [
        ("**\n", "input: expected entries: node, dof, node, dof and value, found none"),
        (
            "*USER ELEMENT, NODES= 4, LINEAR\n",
            "input:1: expected entries of an assembled matrix, found \"*USER ELEMENT, NODES= 4, LINEAR\"",
        ),
        (
            "1, 1,1, 1,1, 2.0\n",
            "input:1: expected node, dof, node, dof and value (an assembled matrix, not ELEMENT BY ELEMENT), found six fields",
        ),
        ("0,1, 1,1, 2.0\n", "input:1:1: expected a node number other than 0, below 2^31, found \"0\""),
        ("1,0, 1,1, 2.0\n", "input:1:3: expected a degree of freedom from 1 to 255, found \"0\""),
        ("1,1, 1,1, 2\n", "input:1:11: expected a value with a decimal point, found \"2\""),
        ("1,1, 1,1\n", "input:1:9: expected a finite number, found the end of the line"),
        (
            "1,1, 1,1, 2.0\n2,1, 1,1, 1.0\n2,1, 1,1, 1.0\n",
            "input:3: expected each position once, found (2+X, 1+X) again",
        ),
    ] {
        assert_eq!(abaqus::read(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
    }
}

#[test]
fn broken_dmig_cards_are_refused_with_a_word() {
    const HEAD: &str = "DMIG,K,0,6,1\n";
    for (text, message) in [
        ("", "input: expected the header of a matrix: DMIG, its name, 0, found none"),
        ("GRID,1\n", "input: expected the header of a matrix: DMIG, its name, 0, found none"),
        ("DMIG,K,1,1,,1,1,1.0\n", "input: expected the header of a matrix: DMIG, its name, 0, found none"),
        (
            "DMIG,K,0,7,1\n",
            "input:1:10: expected IFO = 1 (square), 6 (symmetric), 2 or 9 (rectangular), found \"7\"",
        ),
        ("DMIG,K,0,6,5\n", "input:1:12: expected TIN from 1 to 4, found \"5\""),
        ("DMIG,K,0,6\n", "input:1:11: expected TIN from 1 to 4, found a blank field"),
        (
            "DMIG,TOOLONGNAME,0,6,1\n",
            "input:1:6: expected the name of a matrix, of one to eight characters, found \"TOOLONGNAME\"",
        ),
        ("DMIG,K,0,6,1,,,3\n", "input:1:16: expected a blank field between POLAR and NCOL, found \"3\""),
        (
            "DMIG,K,0,6,1\nDMIG,k,0,6,1\n",
            "input:2: expected one header for each matrix, found K again, first in line 1",
        ),
        (
            "DMIG,K,0,6,1\nDMIG,M,1,1,,1,1,1.0\n",
            "input:2:6: expected a matrix that has a header, found \"M\"",
        ),
        (
            &format!("{HEAD}DMIG,K,x,1,,1,1,1.0\n"),
            "input:2:8: expected a grid from 1 to 2147483647, found \"x\"",
        ),
        (
            &format!("{HEAD}DMIG,K,1,7,,1,1,1.0\n"),
            "input:2:10: expected a component from 0 to 6, found \"7\"",
        ),
        (
            &format!("{HEAD}DMIG,K,1,1,3,1,1,1.0\n"),
            "input:2:12: expected a blank field after the component of the column, found \"3\"",
        ),
        (
            &format!("{HEAD}DMIG,K,1,1,,1,1,12\n"),
            "input:2:17: expected a finite number with a decimal point, found \"12\"",
        ),
        (
            &format!("{HEAD}DMIG,K,1,1,,1,1\n"),
            "input:2:16: expected a finite number with a decimal point, found a blank field",
        ),
        (
            &format!("{HEAD}DMIG,K,1,1,,1,1,1.0,2.0\n"),
            "input:2:21: expected no imaginary part in a real matrix, found \"2.0\"",
        ),
        (
            &format!("{HEAD}DMIG,K,1,1,,1,1,1.0,,+,7\n"),
            "input:2:24: expected at most 8 fields behind the first, found \"7\"",
        ),
        ("DMIG    K\t0       6\n", "input:1:10: expected blanks or commas between fields, found a tab"),
        ("DMIG,K,0,6,1\n,1,1,1.0\n", "input:2:2: expected no more fields behind a header, found \"1\""),
    ] {
        assert_eq!(dmig::read(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
    }
}

#[test]
fn what_is_wrong_with_one_matrix_leaves_the_others() {
    let text = "DMIG,K,0,6,1\nDMIG,M,0,1,1\nDMIG,B,0,9,1,,,,1\n\
                DMIG,K,1,1,,2,1,1.0\nDMIG,K,2,1,,1,1,1.0\nDMIG,M,1,1,,1,1,1.0\nDMIG,B,2,,,1,1,1.0\n";
    let all = dmig::read(text.as_bytes()).unwrap();
    let message = |k: usize| all[k].matrix.as_ref().unwrap_err().to_string();
    assert_eq!(message(0), "input:5: expected each position once, found both (2+X, 1+X) and (1+X, 2+X)");
    assert!(all[1].matrix.is_ok());
    assert_eq!(message(2), "input:3: expected columns up to NCOL = 1, found column 2");
}

#[test]
fn broken_mapping_files_are_refused_with_a_word() {
    const HEAD: &str = "    Matrix Eqn          Node    DOF     \n";
    for (text, message) in [
        (String::new(), "input: expected the headings Matrix Eqn, Node and DOF, found an empty file"),
        ("1 1 UX\n".into(), "input:1: expected the headings Matrix Eqn, Node and DOF, found \"1 1 UX\""),
        (HEAD.into(), "input: expected a row with its node and direction, found none"),
        (
            format!("{HEAD} 2 1 UX\n"),
            "input:2:2: expected the number of the next row from 1 to 1, found \"2\"",
        ),
        (format!("{HEAD} 1 0 UX\n"), "input:2:4: expected a node from 1 to 2147483647, found \"0\""),
        (format!("{HEAD} 1 1 TEMP\n"), "input:2:6: expected UX, UY, UZ, ROTX, ROTY or ROTZ, found \"TEMP\""),
        (format!("{HEAD} 1 1 UX 3\n"), "input:2:9: expected the end of the line, found \"3\""),
        (
            format!("{HEAD} 1 1 UX\n 2 1 UX\n"),
            "input:3: expected each name once, found 1+X again, first in line 2",
        ),
    ] {
        assert_eq!(ansys::read_mapping(text.as_bytes()).unwrap_err().to_string(), message, "{text:?}");
    }
}
