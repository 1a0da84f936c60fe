//! No reader of binary files takes memory for what a header promises and the file does not hold.

use flate2::{Compression, write::ZlibEncoder};
use frfit_formats::{FormatError, NamedMatrix, mat, numpy, op4};
use peak_alloc::PeakAlloc;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// A file of a few hundred bytes: whatever a reader needs for itself is far below, what the headers promise far above.
const MOST: usize = 200_000;

// One test, because the count is for the whole process.
#[test]
fn memory_is_not_taken_for_promises() {
    for (name, bytes) in files() {
        let (read, used) = measured(name, &bytes);
        assert!(used < MOST, "{name}: {used} bytes");
        // Nothing of such a file may be taken for a matrix.
        assert!(!read.is_ok_and(|all| all[0].matrix.is_ok()), "{name}");
    }
    for (name, bytes, message) in bombs() {
        let (read, used) = measured(&name[..3], &bytes);
        let error = match read {
            Err(error) => error,
            Ok(all) => {
                all.into_iter().find_map(|one| one.matrix.err()).unwrap_or_else(|| panic!("{name} is read"))
            }
        };
        assert!(error.to_string().contains(message), "{name}: {error}");
        // What is kept is within 16 x the size + 1 MB; a vector that grows is there twice, the second time of twice the size.
        let limit = 16 * bytes.len() + (1 << 20);
        assert!(used < 3 * limit + MOST, "{name}: {used} bytes of {limit} for a file of {}", bytes.len());
    }
    for (name, bytes, entries) in sound() {
        let (read, used) = measured(&name[..3], &bytes);
        let stored: Vec<usize> =
            read.unwrap().into_iter().map(|one| one.matrix.unwrap().rows.len()).collect();
        assert_eq!(stored, entries, "{name}");
        // Zeros take nothing, however many of them there are.
        assert!(used < 3 * (16 * bytes.len() + (1 << 20)), "{name}: {used} bytes for {}", bytes.len());
    }
}

/// What a reader makes of a file, and the most memory that it takes meanwhile.
fn measured(kind: &str, bytes: &[u8]) -> (Result<Vec<NamedMatrix>, FormatError>, usize) {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let read = match kind {
        "op4" => op4::read(bytes),
        "num" | "npz" | "numpy" => numpy::read(bytes),
        _ => mat::read(bytes),
    };
    (read, MEMORY.peak_usage() - before)
}

/// Bytes of a file that are made as they are written: a megabyte as often as that.
fn repeated(out: &mut impl Write, number: &[u8], megabytes: usize) {
    let block = number.repeat((1 << 20) / number.len());
    (0..megabytes).for_each(|_| out.write_all(&block).unwrap());
}

/// The header of an array in a file of its own.
fn npy(descr: &str, shape: &str) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (header.len() as u16).to_le_bytes();
    [&b"\x93NUMPY\x01\x00"[..], &length, header.as_bytes()].concat()
}

/// A member of an archive: its name, its header, and numbers as many megabytes long.
type Member<'a> = (&'a str, Vec<u8>, &'a [u8], usize);

fn npz(members: &[Member<'_>]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, header, number, megabytes) in members {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(header).unwrap();
        repeated(&mut zip, number, *megabytes);
    }
    zip.finish().unwrap().into_inner()
}

/// The same with the uncompressed sizes in its headers replaced: of members, and in the directory.
fn lying(mut archive: Vec<u8>, size: u32) -> Vec<u8> {
    for (mark, field) in [(b"PK\x03\x04", 22), (b"PK\x01\x02", 24)] {
        let places: Vec<usize> =
            archive.windows(4).enumerate().filter(|(_, w)| w == mark).map(|(k, _)| k).collect();
        assert!(!places.is_empty());
        for place in places {
            archive[place + field..][..4].copy_from_slice(&size.to_le_bytes());
        }
    }
    archive
}

fn integers(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

/// A file of one compressed variable: tag and head as given, then numbers as many megabytes long.
fn matlab(head: &[u8], number: &[u8], megabytes: usize) -> Vec<u8> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
    packed.write_all(head).unwrap();
    repeated(&mut packed, number, megabytes);
    let packed = packed.finish().unwrap();
    let tag = integers(&[15, packed.len() as u32]);
    [&[b' '; 124][..], b"\x00\x01IM", &tag, &packed].concat()
}

/// Tag and head of a variable K of this class, whose next element holds so many megabytes of this type.
fn variable(class: u32, size: [u32; 2], element: u32, megabytes: u32) -> Vec<u8> {
    let length = megabytes << 20;
    integers(&[
        14,
        48 + length,
        6,
        8,
        class,
        0,
        5,
        8,
        size[0],
        size[1],
        1 | 1 << 16,
        u32::from(b'K'),
        element,
        length,
    ])
}

const ONE: [u8; 8] = 1.0_f64.to_le_bytes();

/// Small files that inflate to tens of megabytes, and what is said of them.
fn bombs() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    const KEPT: &str = "(16 x the ";
    const NEEDED: &str = "(128 x the ";
    const IMPOSSIBLE: &str = "(1032 x the ";
    let ones = |mark: &str| npz(&[(mark, npy("<f8", "(2048, 2048)"), &ONE, 32)]);
    let scalar = |text: &str| [npy("|S3", "()"), text.as_bytes().to_vec()].concat();
    let sparse = |name, descr, count: usize, number: &'static [u8]| -> Vec<Member<'static>> {
        let mut members = vec![
            ("format.npy", scalar("csc"), &[0][..], 0),
            ("shape.npy", [npy("<i8", "(2,)"), [3_u64.to_le_bytes(); 2].concat()].concat(), &[0][..], 0),
            ("data.npy", [npy("<f8", "(1,)"), ONE.to_vec()].concat(), &[0][..], 0),
            ("indices.npy", [npy("|u1", "(1,)"), vec![0]].concat(), &[0][..], 0),
            ("indptr.npy", [npy("|u1", "(4,)"), vec![0, 1, 1, 1]].concat(), &[0][..], 0),
        ];
        let shape = format!("({},)", (count << 20) / number.len());
        members.iter_mut().filter(|member| member.0 == name).for_each(|member| {
            *member = (member.0, npy(descr, &shape), number, count);
        });
        members
    };
    let mut several = (0..64).map(|k| (format!("a{k}.npy"), npy("<f8", "(1024, 128)"))).collect::<Vec<_>>();
    let several: Vec<Member<'_>> =
        several.iter_mut().map(|(name, header)| (&**name, header.clone(), &ONE[..], 1)).collect();
    let nested = npz(&[("inside.npz", ones("K.npy"), &[0], 0)]);
    let mut as_an_array = zip::ZipWriter::new(Cursor::new(Vec::new()));
    as_an_array.start_file("K.npy", SimpleFileOptions::default()).unwrap();
    as_an_array.write_all(&ones("K.npy")).unwrap();
    let as_an_array = as_an_array.finish().unwrap().into_inner();
    let mut one = variable(6, [1, 1], 9, 0);
    one[4..8].copy_from_slice(&56_u32.to_le_bytes());
    one[52..56].copy_from_slice(&8_u32.to_le_bytes());
    one.extend(ONE);
    let small = |megabytes| matlab(&one, &[0], megabytes);
    let mut short = variable(6, [2048, 2048], 9, 32);
    short[4..8].copy_from_slice(&64_u32.to_le_bytes());
    vec![
        // Honest, and nothing but ones.
        ("npz", ones("K.npy"), KEPT),
        ("npz of bytes", npz(&[("K.npy", npy("|i1", "(4096, 8192)"), &[1], 32)]), KEPT),
        ("npz of several", npz(&several), KEPT),
        ("npz sparse data", npz(&sparse("data.npy", "<f8", 32, &ONE)), NEEDED),
        ("npz sparse indices", npz(&sparse("indices.npy", "<i4", 32, &[0; 4])), NEEDED),
        ("npz sparse pointers", npz(&sparse("indptr.npy", "<i8", 32, &[0; 8])), NEEDED),
        ("npz text", npz(&sparse("format.npy", "<U8", 32, &[65, 0, 0, 0, 0, 0, 0, 0])), KEPT),
        // More than the array declares, and less.
        (
            "npz longer",
            npz(&[("K.npy", npy("<f8", "(1, 1)"), &ONE, 32)]),
            "expected 8 bytes for an array of 1 x 1 (array \"K\"), found more bytes",
        ),
        ("npz shorter", npz(&[("K.npy", npy("<f8", "(90000, 90000)"), &ONE, 0)]), IMPOSSIBLE),
        ("npz no array", npz(&[("K.npy", npy("<f8", "(4194304,)"), &ONE, 32)]), "found a vector of 4194304"),
        ("npz no header", npz(&[("K.npy", vec![], &[0], 32)]), "expected an array of NumPy"),
        // What the archive says of a member is not what its array says, nor what is there.
        ("npz says less", lying(ones("K.npy"), 8), "larger than its declared uncompressed size"),
        (
            "npz says more",
            lying(npz(&[("K.npy", npy("<f8", "(90000, 90000)"), &ONE, 0)]), 0xFFFF_FFF0),
            IMPOSSIBLE,
        ),
        ("npz nested", nested, "a zip archive of 1 others, the first \"inside.npz\""),
        ("npz as an array", as_an_array, "expected an array of NumPy"),
        // A compressed variable: honest, and with a tag that says less, or more.
        ("mat", matlab(&variable(6, [2048, 2048], 9, 32), &ONE, 32), KEPT),
        ("mat of bytes", matlab(&variable(6, [4096, 8192], 1, 32), &[1], 32), KEPT),
        ("mat sparse", matlab(&variable(5, [3, 3], 5, 32), &[0; 4], 32), NEEDED),
        ("mat name", matlab(&integers(&[14, 32 << 20, 6, 8, 6, 0, 5, 8, 1, 1, 1, 24 << 20]), b"K", 30), KEPT),
        ("mat longer", small(32), "expected a compressed variable of 64 bytes, as its tag says, found more"),
        (
            "mat tag too short",
            matlab(&short, &ONE, 32),
            "expected 33554432 bytes: the values of a matrix, found 16 to the end",
        ),
        ("mat tag too long", matlab(&variable(6, [2048, 2048], 9, 32), &[0], 1), "found 0 to the end"),
    ]
}

/// Files of matrices that are mostly zeros, which inflate to hundreds of times their size and are read all the same, and how many entries each has.
fn sound() -> Vec<(&'static str, Vec<u8>, Vec<usize>)> {
    let numbers = |zeros: &[u8]| [&ONE[..], zeros].concat();
    let zeros = vec![0; (1 << 20) - 8];
    // One number at the head of each megabyte.
    let block = numbers(&zeros);
    vec![
        (
            "npz",
            npz(&[
                ("K.npy", npy("<f8", "(2048, 2048)"), &block, 32),
                ("M.npy", npy("<f8", "(2048, 2048)"), &[0; 8], 32),
            ]),
            vec![32, 0],
        ),
        ("mat", matlab(&variable(6, [2048, 2048], 9, 32), &block, 32), vec![32]),
    ]
}

fn files() -> Vec<(&'static str, Vec<u8>)> {
    let words = |numbers: &[i32]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let record =
        |body: Vec<u8>| [words(&[body.len() as i32]), body.clone(), words(&[body.len() as i32])].concat();
    let head = record([words(&[2_000_000_000, 2_000_000_000, 2, 2]), b"KAA     ".to_vec()].concat());
    let dense = [words(&[1, 1, 2_000_000_000]), vec![0; 80]].concat();
    let text = "200000002000000000       2       2KAA     1P,3E23.16\n       1       120000000\n 1.0000000000000000E+00\n";
    let sparse = "20000000-2000000       2       2KAA     1P,3E23.16\n       1       090000000\n80000001       1\n 1.0000000000000000E+00\n";
    let array = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        [
            b"\x93NUMPY\x01\x00".to_vec(),
            (header.len() as u16).to_le_bytes().to_vec(),
            header.into_bytes(),
            vec![0; 80],
        ]
        .concat()
    };
    let matlab = |class: i32, length: i32| {
        let mut bytes = vec![b' '; 124];
        bytes.extend(b"\x00\x01IM");
        bytes.extend(words(&[14, 160, 6, 8, class, 2_000_000_000, 5, 8, 2_000_000_000, 2_000_000_000]));
        bytes.extend(words(&[1 | 1 << 16, i32::from(b'K'), 5, length]));
        bytes.extend([0; 200]);
        bytes
    };
    vec![
        ("op4", [head.clone(), record(dense)].concat()),
        ("op4", [head, words(&[2_000_000_000]), vec![0; 80]].concat()),
        ("op4", text.into()),
        ("op4", sparse.into()),
        ("numpy", array("(2000000000, 2000000000)")),
        ("numpy", array("(4000000000000000000, 0)")),
        ("numpy", array("(2000000000,)")),
        ("mat", matlab(6, 8)),
        ("mat", matlab(5, 8)),
        ("mat", matlab(5, 2_000_000_000)),
        ("mat", matlab(2, 2_000_000_000)),
    ]
}
