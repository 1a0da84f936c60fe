//! Where figures go.

use frfit_figures::Figure;
use std::path::Path;

/// Writes a figure as SVG and PNG into `bench` in the build folder, two levels above this program, and prints where.
///
/// # Errors
/// Where the folder or a file cannot be written.
pub fn save(name: &str, figure: &Figure) -> Result<(), Box<dyn std::error::Error>> {
    let program = std::env::current_exe()?;
    let folder = program.ancestors().nth(2).unwrap_or(Path::new("target")).join("bench");
    std::fs::create_dir_all(&folder)?;
    let (svg, png) = (folder.join(format!("{name}.svg")), folder.join(format!("{name}.png")));
    std::fs::write(&svg, figure.svg())?;
    std::fs::write(&png, figure.png(1.25)?)?;
    println!("{}\n{}", svg.display(), png.display());
    Ok(())
}
