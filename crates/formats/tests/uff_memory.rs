//! Reading takes at most 16 times the memory of the file, whatever the file promises.

use frfit_formats::uff;
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Bytes that reading may take beside 16 times the file.
const SLACK: usize = 1 << 20;

// One test, since the memory of tests that run at the same time adds up.
#[test]
fn memory_is_bounded_by_the_length_of_the_file() {
    let header = "\n\n\n\n\n4\n";
    let axes = "0\n0\n0\n0\n";
    let files = [
        // As many datasets as fit, empty and with as much in memory as a number in the file can make.
        "    -1\n15\n    -1\n".repeat(50_000),
        "    -1\n151\n\n\n\n\n\n\n\n    -1\n".repeat(50_000),
        "    -1\n164\n9\n1 1 1 1\n    -1\n".repeat(50_000),
        "    -1\n82\n1 0 0\n\n    -1\n".repeat(50_000),
        format!("    -1\n58\n{header}2 0 0 0 0 0\n{axes}    -1\n").repeat(20_000),
        format!("    -1\n58\n{header}2 9999999999 1 0 0 0\n{axes}1\n    -1\n").repeat(20_000),
        // One dataset with as many numbers as fit.
        format!("    -1\n58\n{header}2 9999999999 1 0 0 0\n{axes}{}\n    -1\n", "1 ".repeat(500_000)),
        format!("    -1\n58\n{header}5 9999999999 0 0 0 0\n{axes}{}\n    -1\n", "1\n".repeat(500_000)),
        format!(
            "    -1\n58b     1     2\n{header}2 9999999999 1 0 0 0\n{axes}{}    -1\n",
            "x".repeat(1_000_000)
        ),
        format!(
            "    -1\n58b     1     2\n{header}6 9999999999 0 0 0 0\n{axes}{}    -1\n",
            "x".repeat(1_000_000)
        ),
        format!("    -1\n82\n1 9999999999 0\n\n{}\n    -1\n", "1 ".repeat(500_000)),
        format!("    -1\n82\n1 500000 0\n\n{}\n    -1\n", "1 ".repeat(500_000)),
        format!("    -1\n15\n{}    -1\n", "1 1 1 1 1 1 1\n".repeat(70_000)),
        format!("    -1\n15\n{}    -1\n", "1\n".repeat(500_000)),
        format!("    -1\n2411\n{}    -1\n", "1 1 1 1\n1 1 1\n".repeat(70_000)),
        // Long lines and long runs of blanks, of delimiters and of what looks like them.
        format!("    -1\n    58\n{}\n    -1\n", "\u{fc}".repeat(500_000)),
        "    -1\n".repeat(150_000),
        "    -1".repeat(150_000),
        format!("    -1\n    58b\n{}", "    -1\n \n".repeat(100_000)),
        format!("    -1\n   999\n{}", "    -1\n x\n".repeat(100_000)),
        format!("    -1\n   999\n{}", "\n".repeat(1_000_000)),
    ];
    for (index, file) in files.iter().enumerate() {
        MEMORY.reset_peak_usage();
        let before = MEMORY.current_usage();
        let records = uff::read_all(file.as_bytes()).map(|records| records.len());
        let taken = MEMORY.peak_usage() - before;
        let allowed = 16 * file.len() + SLACK;
        assert!(taken <= allowed, "file {index}: {taken} bytes for {} ({records:?})", file.len());
    }
}
