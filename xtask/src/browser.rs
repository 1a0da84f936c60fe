//! The report, and the site where it is built, in a real browser: `crates/report/browser`.

use crate::step::{Step, cargo, run, target, works, workspace};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The version that the checks were written for; it drives a Chromium that is there and brings none.
const PLAYWRIGHT: &str = "playwright-core@1.65.1";

/// Examples whose reports are looked at, with options of `identify`: the paper's series with an error map, one where it diverges, a real factor, a rule that
/// leaves most frequencies ambiguous, many frequencies with error bars, two sensors that agree, two numbers that hold for the band and hang together, two curves.
const EXAMPLES: [(&str, &[&str]); 8] = [
    ("rubber-bar", &[]),
    ("clamped-plate", &[]),
    ("density", &[]),
    ("rubber-bar-end", &["--selection", "smallest"]),
    ("hammer-bar", &["--method", "rational", "--selection", "joint"]),
    ("sandwich", &[]),
    ("added-mass", &[]),
    ("two-materials", &[]),
];

/// Reports of the examples and of large results, each opened and worked with in Chromium. Where something that it needs can be neither found nor installed,
/// says so and does nothing.
pub(crate) fn browser() -> Vec<Step> {
    match tools() {
        Ok(chromium) => check(&chromium),
        Err(missing) => {
            println!("── browser\nSKIPPED: {missing}: the report was not looked at in a browser");
            Vec::new()
        }
    }
}

/// The browser, with Node and npm there too; else what is missing.
fn tools() -> Result<PathBuf, String> {
    if chromium().is_none() {
        // Without fonts every letter is a box.
        install(&["chromium", "fonts-dejavu-core"]);
    }
    let chromium = chromium().ok_or("Chromium is missing (apt-get install chromium)")?;
    for (program, package) in [("node", "nodejs"), ("npm", "npm")] {
        let there = || works(Command::new(program).arg("--version"));
        if !there() {
            install(&[package]);
        }
        if !there() {
            return Err(format!("{program} is missing (apt-get install {package})"));
        }
    }
    Ok(chromium)
}

fn chromium() -> Option<PathBuf> {
    let known = ["chromium", "chromium-browser", "google-chrome"];
    let paths = known.iter().map(|name| Path::new("/usr/bin").join(name));
    paths.into_iter().find(|path| works(Command::new(path).arg("--version")))
}

/// Installs Debian packages, where that is possible; whether they are there is asked afterwards.
fn install(packages: &[&str]) {
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout.trim_ascii() == b"0");
    if is_root && works(Command::new("apt-get").arg("--version")) {
        println!("── apt-get install {}", packages.join(" "));
        // A fresh system has no list of packages.
        works(Command::new("apt-get").args(["update", "--quiet"]));
        let install = ["install", "--yes", "--quiet", "--no-install-recommends"];
        works(Command::new("apt-get").args(install).args(packages).env("DEBIAN_FRONTEND", "noninteractive"));
    }
}

fn check(chromium: &Path) -> Vec<Step> {
    let folder = target().join("browser");
    let (reports, pictures) = (folder.join("reports"), folder.join("pictures"));
    let source = workspace().join("crates/report/browser");
    // Node looks for packages beside the scripts and above them: so the scripts are copied beside their package.
    let scripts = folder.join("scripts");
    if let Err(error) = copy(&source, &scripts) {
        println!("── browser\nSKIPPED: {}: {error}", scripts.display());
        return Vec::new();
    }
    let mut npm = Command::new("npm");
    npm.args(["install", "--ignore-scripts", "--no-audit", "--no-fund", "--prefix"])
        .arg(&folder)
        .arg(PLAYWRIGHT);
    if !works(&mut npm) {
        println!(
            "── browser\nSKIPPED: npm cannot install {PLAYWRIGHT}: the report was not looked at in a browser"
        );
        return Vec::new();
    }
    let built = run("frfit", &mut cargo(["build", "--quiet", "--package", "frfit-cli"]));
    let frfit = target().join("debug/frfit");
    let mut passed = built.passed;
    for (name, options) in EXAMPLES {
        let case = folder.join("cases").join(name);
        let frfit = |arguments: &[&str]| {
            let mut command = Command::new(&frfit);
            command.arg("--quiet").args(arguments).current_dir(&folder);
            command
        };
        passed &= works(frfit(&["example", name]).arg(&case));
        if name == "hammer-bar" {
            // Its FRF is made of its records first.
            passed &= works(frfit(&["frf", "records.lvm", "-o", "frf.uff"]).current_dir(&case));
        }
        let mut identify = frfit(&["identify", "case.toml", "--out"]);
        passed &= works(identify.arg(reports.join(name)).args(options).current_dir(&case));
    }
    passed &= works(Command::new("node").arg(scripts.join("large.mjs")).arg(reports.join("large")));
    passed &= works(Command::new(&frfit).args(["--quiet", "report"]).arg(reports.join("large")));
    let mut made = built;
    made.passed = passed;
    let mut look = Command::new("node");
    look.arg(scripts.join("check.mjs")).arg(chromium).arg(&reports).arg(&pictures);
    let looked = run("browser", &mut look);
    let mut steps = vec![Step { name: "reports", ..made }, looked];
    let site = target().join("site");
    if site.join("index.html").is_file() {
        let mut look = Command::new("node");
        look.arg(scripts.join("site.mjs")).arg(chromium).arg(&site).arg(&pictures);
        steps.push(run("site, looked at", &mut look));
    }
    println!("pictures: {}", pictures.display());
    steps
}

/// The files of a folder, into another one.
fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(to)?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        std::fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}
