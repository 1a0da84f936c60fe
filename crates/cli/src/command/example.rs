//! `frfit example`

use super::{say, say_json};
use crate::args::{Args, Example};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::Reads;
use frfit_workflow::output::{File, write_unedited};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &Args, example: &Example) -> Result<Outcome, Failure> {
    let Some(name) = &example.name else { return list(args) };
    let dir = example.dir.clone().unwrap_or_else(|| PathBuf::from(name));
    let files = write(name, &dir)?;
    if args.json {
        say_json(&json!({"name": name, "dir": dir.display().to_string(), "files": files}))?;
    } else if !args.quiet {
        let (case, shown) = (dir.join("case.toml"), dir.display());
        let records = frfit_examples::list().iter().find(|example| example.name == name);
        let first = records.and_then(|example| example.records()).map_or(String::new(), |records| {
            format!("frfit frf {} -o {} && ", dir.join(records).display(), dir.join("frf.uff").display())
        });
        say(&format!(
            "wrote {shown}: {}\nnow run: {first}frfit identify {} --out {}\n",
            files.join(", "),
            case.display(),
            dir.join("out").display()
        ))?;
    }
    Ok(Outcome::Done)
}

/// Writes an example into a folder and returns the names of its files; what was edited there is not overwritten.
pub(crate) fn write(name: &str, dir: &Path) -> Result<Vec<String>, Failure> {
    let files = frfit_examples::generate(name).map_err(|error| Failure::Input(error.to_string()))?;
    let names = files.iter().map(|file| file.path.clone()).collect();
    let files: Vec<File> = files.into_iter().map(|file| File::new(file.path, file.bytes)).collect();
    write_unedited(dir, files, &Reads::default())?;
    Ok(names)
}

fn list(args: &Args) -> Result<Outcome, Failure> {
    if args.json {
        let names: Vec<Value> = frfit_examples::list()
            .iter()
            .map(|example| json!({"name": example.name, "summary": example.summary}))
            .collect();
        say_json(&Value::from(names))?;
    } else {
        for example in frfit_examples::list() {
            say(&format!("{:17} {}\n", example.name, example.summary))?;
        }
    }
    Ok(Outcome::Done)
}
