//! What can be said on the command line.

use clap::{Parser, Subcommand};
use frfit::laws::{LawKind, UnknownLawKind};
use frfit_workflow::batch::Shard;
use frfit_workflow::export::{Target, UnitSystem};
use frfit_workflow::load;
use frfit_workflow::sensitivities::Candidates;
use std::path::PathBuf;

/// Options of every command stand last, whatever else there is.
const LAST: usize = 1000;

/// Update a finite element model until its FRFs match a test.
#[derive(Debug, Parser)]
#[command(name = "frfit", version, arg_required_else_help = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// No progress bar, and no output on success except warnings and findings
    #[arg(long, global = true, display_order = LAST)]
    pub(crate) quiet: bool,

    /// Results as JSON on standard output
    #[arg(long, global = true, display_order = LAST)]
    pub(crate) json: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run the main job on a built-in case: a rubber bar with a wrong modulus, corrected
    #[command(
        after_help = "Example: frfit demo\n\nWrites the case to frfit-demo/ and the results to frfit-demo/out/."
    )]
    Demo(Demo),
    /// Write a complete runnable case with a known answer; without a name, list them
    #[command(
        after_help = "Example: frfit example rubber-bar bar && frfit identify bar/case.toml --out bar/out"
    )]
    Example(Example),
    /// Compute FRFs from the records of a hammer test
    #[command(after_help = "Examples: frfit frf records.lvm -o frf.uff\n          \
                      frfit frf impacts.csv -o frf.csv --force-sensitivity 22.4mV/N --response-sensitivity 100mV/g\n\n\
                      Records: UFF time functions, LabVIEW measurement files (.lvm), tables with a column time_s and units in the \
                      names of the others, such as \"Force (N)\". Impacts with a fault are left out, with the reason.")]
    Frf(Frf),
    /// Say what is wrong with measurements against the model
    #[command(after_help = "Example: frfit check case.toml\n\n\
                      Looks for conjugated, reversed, delayed and wrongly scaled FRFs, for receptance, mobility and accelerance taken for one another, \
                      for sensors and loads at other rows than the case says, and for a band beyond the mesh.\n\n\
                      Exit code: 0 done; 1 with --strict where something is found; 2 the input is at fault; 3 a fault of frfit.")]
    Check(Check),
    /// Find the parameter that makes the model's response the measured one
    #[command(after_help = "Example: frfit identify case.toml --out results --order 30 --band 200:1550\n\n\
                      Exit code: 0 done; 1 with --strict where some frequency has no trusted answer; 2 the input is at fault; \
                      3 a fault of frfit.")]
    Identify(Identify),
    /// Train the reduced model of a case once, for many identifications
    #[command(
        after_help = "Example: frfit train case.toml --out model.frfit && frfit identify case.toml --reduced model.frfit --out results\n\n\
                      It serves every case with the same matrices, load and sensors: other specimens, temperatures, bounds, laws. Within the band and the \
                      range of the unknowns in the training a run needs few or no factorisations; beyond them it trains further."
    )]
    Train(Train),
    /// Do many identifications by one plan, a table of cases and of the values that differ
    #[command(
        args_conflicts_with_subcommands = true,
        after_help = "Examples: frfit batch plan.csv --out store --reduced model.frfit\n          \
                      frfit batch status plan.csv --out store\n          \
                      frfit batch collect store -o all.csv\n\n\
                      A plan is a table with a column case (the path of a case file). Columns with a dot in their name are keys of the case, such as measurement.file or \
                      identify.bounds.storage, and a cell is what would stand there; other columns are labels, such as specimen. Run it again to do what is missing. \
                      In a task of a Slurm array of jobs its share is done."
    )]
    Batch(Batch),
    /// Fit laws of a few parameters to a table of a modulus over frequency
    #[command(after_help = "Examples: frfit fit results/identified.csv\n          \
                      frfit fit dma.csv --law fractional,zener,maxwell:5 --out laws\n\n\
                      Columns: frequency_hz (or frequency, freq, f), storage (storage_modulus, E_stor), loss_factor (tan_delta) or \
                      loss (loss_modulus, E_loss); storage_std and loss_factor_std, if they are known; status (only rows with status ok are used). \
                      A line of units below the names is understood.")]
    Fit(Fit),
    /// Make the HTML page of results again, as identify writes it
    #[command(after_help = "Example: frfit report results\n\n\
                      One file that needs no network: verdict, plots, table, inputs with checksums. Open results/report.html in a browser.")]
    Report(Report),
    /// Write the identified modulus as the table that another solver reads
    #[command(
        after_help = "Examples: frfit export nastran results/identified.csv -o core.bdf --poisson 0.45 --id 7\n          \
                      frfit export abaqus results/identified.csv --law laws/law.json -o core.inp --poisson 0.45 --name CORE\n\n\
                      nastran: MAT1 and two TABLED1 for SDAMPING in SOL 108; abaqus: *ELASTIC and *VISCOELASTIC, FREQUENCY=TABULAR; \
                      ansys: TB,ELASTIC and TB,SDAMP over TBFIELD,FREQ; csv and json: frequency, modulus, loss factor, their standard deviations, status, units. \
                      How each is to be used stands at the head of the file."
    )]
    Export(Export),
    /// Compute the model's response at its nominal factors
    #[command(after_help = "Example: frfit respond case.toml --out response --band 20:2000")]
    Respond(Respond),
    /// Rank the model's parameters, say which the sensors cannot separate and where the next sensor should go
    #[command(after_help = "Examples: frfit sensitivities case.toml --out sensitivities\n          \
                      frfit sensitivities case.toml --noise 0.02 --candidates 12+Z,55+Z\n\n\
                      About the model as it is: nothing needs to be measured. A [[measurement]] may be a dof alone, with [respond] for the frequencies. \
                      Parameters are the factor of each [[matrix]] and [[attached]], of complex ones the loss factor for itself, and a scale = \"unknown\".")]
    Sensitivities(Sensitivities),
    /// Natural frequencies, damping and shapes of the model and of the measurement, paired
    #[command(after_help = "Examples: frfit modes case.toml --out modes\n          \
                      frfit modes case.toml --identified results/identified.csv\n\n\
                      Modes of the model have the damping of its factors; poles of the measurement are fitted to all FRFs together, with standard deviations. \
                      Without files of measurements the model's modes alone. MAC compares shapes at the sensors, FRAC and COMAC each sensor over the band and over the pairs.")]
    Modes(Modes),
    /// Say what is in a matrix, FRF or table file
    #[command(
        after_help = "Examples: frfit inspect frf.uff\n          frfit inspect K.mtx M.mtx --modes 6\n          frfit inspect --json frf.uff"
    )]
    Inspect(Inspect),
    /// Convert a matrix or an FRF to another format, by the endings of the names
    #[command(
        after_help = "Examples: frfit convert bcsstk09.rsa bcsstk09.mtx\n          frfit convert model.mat K.mtx --name K\n          frfit convert frf.uff frf.csv --record 2\n          frfit convert analyser.csv frf.csv --columns frequency_hz,magnitude_db,phase_deg"
    )]
    Convert(Convert),
    /// Print a script with which a shell completes commands and options
    #[command(
        after_help = "Examples: frfit completions bash > ~/.local/share/bash-completion/completions/frfit\n          \
                      frfit completions zsh > ~/.zfunc/_frfit\n          \
                      frfit completions fish > ~/.config/fish/completions/frfit.fish"
    )]
    Completions(Completions),
    /// Write the manual pages
    #[command(after_help = "Example: frfit man ~/.local/share/man/man1 && man frfit-identify")]
    Man(Man),
}

#[derive(Debug, clap::Args)]
pub(crate) struct Demo {
    /// Folder to write to
    #[arg(long, default_value = "frfit-demo", value_name = "DIR")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Example {
    /// Name of the example
    pub(crate) name: Option<String>,
    /// Folder to write it to (by default its name)
    pub(crate) dir: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Frf {
    /// Files with the records; several recordings are taken as one impact each
    #[arg(required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// File to write; .uff or .csv says the format. A summary and figures are written beside it. - for standard output
    #[arg(short, long, value_name = "FRF")]
    pub(crate) out: PathBuf,
    /// Format of the file in place of that of its name, such as uff or csv
    #[arg(long, value_name = "ENDING")]
    pub(crate) to: Option<String>,
    /// Channel of the force, by name or number (default: the one in a unit of force)
    #[arg(long, value_name = "CHANNEL")]
    pub(crate) force: Option<String>,
    /// Channel of a response, by name or number; may be repeated (default: all in a unit of motion)
    #[arg(long = "response", value_name = "CHANNEL")]
    pub(crate) responses: Vec<String>,
    /// Unit of the force's samples, in place of the file's: N, kN, lbf, V, mV
    #[arg(long, value_name = "UNIT")]
    pub(crate) force_unit: Option<frfit::signal::Unit>,
    /// Unit of the responses' samples, in place of the file's: g, m/s^2, m/s, mm, V, mV
    #[arg(long, value_name = "UNIT")]
    pub(crate) response_unit: Option<frfit::signal::Unit>,
    /// Sensitivity of the hammer, where its samples are a voltage, such as 22.4mV/N
    #[arg(long, value_name = "VALUE")]
    pub(crate) force_sensitivity: Option<frfit::signal::Sensitivity>,
    /// Sensitivity of the sensors, where their samples are a voltage, such as 100mV/g
    #[arg(long, value_name = "VALUE")]
    pub(crate) response_sensitivity: Option<frfit::signal::Sensitivity>,
    /// Driven degree of freedom, such as 12+Z
    #[arg(long, value_name = "DOF")]
    pub(crate) force_dof: Option<frfit::dof::DofName>,
    /// Measured degree of freedom, such as 34+Z; one for each response
    #[arg(long = "response-dof", value_name = "DOF")]
    pub(crate) response_dofs: Vec<frfit::dof::DofName>,
    /// h1 (noise in the response), h2 (in the force) or hv (in both)
    #[arg(long)]
    pub(crate) estimator: Option<frfit::signal::Estimator>,
    /// Force from which on there is an impact (default: a tenth of the largest)
    #[arg(long, value_name = "NEWTON", value_parser = number, allow_negative_numbers = true)]
    pub(crate) trigger: Option<f64>,
    /// Time before the trigger that belongs to a record
    #[arg(long, value_name = "SECONDS", value_parser = number, allow_negative_numbers = true)]
    pub(crate) pre_trigger: Option<f64>,
    /// Length of a record (default: that of a recording with one impact, else up to the next impact)
    #[arg(long, value_name = "SECONDS", value_parser = number, allow_negative_numbers = true)]
    pub(crate) length: Option<f64>,
    /// Share of an impact that a second contact must reach to be called a double impact (default: 0.1)
    #[arg(long, value_name = "SHARE", value_parser = number, allow_negative_numbers = true)]
    pub(crate) double_impact: Option<f64>,
    /// Share of a channel's largest value by which its mean may move (default: 0.05)
    #[arg(long, value_name = "SHARE", value_parser = number, allow_negative_numbers = true)]
    pub(crate) drift: Option<f64>,
    /// Force window: zero from so long after the trigger
    #[arg(long, value_name = "SECONDS", value_parser = number, allow_negative_numbers = true)]
    pub(crate) force_window: Option<f64>,
    /// Exponential window: time constant of the decay that is put on both channels; `frfit identify` takes it into the model
    #[arg(long, value_name = "SECONDS", value_parser = number, allow_negative_numbers = true)]
    pub(crate) exponential_window: Option<f64>,
    /// Impacts to average whatever is wrong with them, such as 1,3
    #[arg(long, value_name = "IMPACTS", value_delimiter = ',')]
    pub(crate) keep: Vec<usize>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Check {
    /// Case file
    pub(crate) case: PathBuf,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Reduced model of frfit train, for the same matrices, load and sensors
    #[arg(long, value_name = "FILE")]
    pub(crate) reduced: Option<PathBuf>,
    /// Memory that may be used, in MB (by default what is available): a model that needs more is refused
    #[arg(long, value_name = "MB")]
    pub(crate) memory: Option<u64>,
    /// Exit with 1 where something is found
    #[arg(long)]
    pub(crate) strict: bool,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Identify {
    /// Case file
    pub(crate) case: PathBuf,
    /// Folder for the results (default: beside the case, such as case-results for case.toml)
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Order of the series, in place of the case's
    #[arg(long, value_name = "N")]
    pub(crate) order: Option<usize>,
    /// Method: rational, series or nelder-mead
    #[arg(long)]
    pub(crate) method: Option<String>,
    /// Choice among several solutions: joint or smallest
    #[arg(long)]
    pub(crate) selection: Option<String>,
    /// Model at each frequency: full, subspace (reduced), or auto
    #[arg(long)]
    pub(crate) reduction: Option<String>,
    /// Reduced model of frfit train, for the same matrices, load and sensors; within its band and its range of the unknowns a run needs few or no factorisations
    #[arg(long, value_name = "FILE")]
    pub(crate) reduced: Option<PathBuf>,
    /// File for the reduced model as this run leaves it, for other runs
    #[arg(long, value_name = "FILE")]
    pub(crate) keep_reduced: Option<PathBuf>,
    /// Memory that may be used, in MB (by default what is available): a model that needs more is refused
    #[arg(long, value_name = "MB")]
    pub(crate) memory: Option<u64>,
    /// Only for `--method series`: number of frequencies in the plot of the error over the order; 0 for no plot (default: 60, above 300 dofs 30, above 5000 none)
    #[arg(long, value_name = "N")]
    pub(crate) error_map: Option<usize>,
    /// Exit with 1 where some frequency has no trusted answer
    #[arg(long)]
    pub(crate) strict: bool,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Train {
    /// Case file
    pub(crate) case: PathBuf,
    /// File to write
    #[arg(short, long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Reduced model to train further
    #[arg(long, value_name = "FILE")]
    pub(crate) reduced: Option<PathBuf>,
    /// Memory that may be used, in MB (by default what is available): a model that needs more is refused
    #[arg(long, value_name = "MB")]
    pub(crate) memory: Option<u64>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Batch {
    #[command(subcommand)]
    pub(crate) action: Option<BatchAction>,
    #[command(flatten)]
    pub(crate) run: Option<BatchRun>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct BatchRun {
    /// Table of runs
    pub(crate) plan: PathBuf,
    /// Folder for the results, one folder a run
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Reduced model of frfit train, for all runs
    #[arg(long, value_name = "FILE")]
    pub(crate) reduced: Option<PathBuf>,
    /// Share of the plan, such as 1/4 (default: that of a task of a Slurm array of jobs, else all)
    #[arg(long, value_name = "I/N")]
    pub(crate) shard: Option<Shard>,
    /// Runs at a time, each on one thread (default: as many as there are cores)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) jobs: Option<u16>,
    /// Runs to do again: failed
    #[arg(long, value_name = "WHICH")]
    pub(crate) retry: Option<RetryWhich>,
    /// Memory that a run may use, in MB (by default what is available)
    #[arg(long, value_name = "MB")]
    pub(crate) memory: Option<u64>,
    /// Print a job script for Slurm with so many tasks, and do nothing else
    #[arg(long, value_name = "TASKS")]
    pub(crate) print_sbatch: Option<usize>,
    /// Exit with 1 where a run failed
    #[arg(long)]
    pub(crate) strict: bool,
}

#[derive(Debug, clap::Args)]
pub(crate) struct BatchPlan {
    /// Table of runs
    pub(crate) plan: PathBuf,
    /// Folder with the results of frfit batch
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Reduced model that the runs are done with
    #[arg(long, value_name = "FILE")]
    pub(crate) reduced: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(crate) enum RetryWhich {
    /// Runs that failed
    Failed,
}

#[derive(Debug, Subcommand)]
pub(crate) enum BatchAction {
    /// Say how many runs of a plan are done, failed and missing
    Status(BatchPlan),
    /// Make one table of all runs
    Collect(Collect),
}

#[derive(Debug, clap::Args)]
pub(crate) struct Collect {
    /// Folder with the results of frfit batch
    pub(crate) store: PathBuf,
    /// Table to write (CSV), - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// A row for each line of each run, in place of a row for each run
    #[arg(long)]
    pub(crate) lines: bool,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Fit {
    /// Table of the modulus: an identified.csv, or one of dynamic mechanical analysis
    pub(crate) table: PathBuf,
    /// Only rows with this value in a column, as of one temperature: T=20
    #[arg(long = "where", value_name = "COLUMN=VALUE", value_parser = cell)]
    pub(crate) only: Option<(String, String)>,
    /// Laws to compare: constant, fractional, zener, maxwell or maxwell:N (N branches), or all (by default; maxwell with 1 to 4)
    #[arg(long = "law", value_name = "LAWS", value_delimiter = ',', value_parser = laws)]
    pub(crate) laws: Vec<Laws>,
    /// Folder for law.json and a figure
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Report {
    /// Folder with the results of identify; report.html is written into it
    #[arg(value_name = "DIR")]
    pub(crate) results: PathBuf,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Export {
    /// nastran, abaqus, ansys, csv or json
    pub(crate) format: Target,
    /// Table of the modulus: an identified.csv, or one of dynamic mechanical analysis
    pub(crate) table: PathBuf,
    /// File to write, - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Units to write, as mm-t-s (MPa, t/mm^3); by default those of the case that the table came of, else SI (Pa, kg/m^3)
    #[arg(long, value_name = "SYSTEM")]
    pub(crate) unit_system: Option<UnitSystem>,
    /// Poisson's ratio, taken as real and constant; a solver needs it
    #[arg(long, value_name = "RATIO", value_parser = number, allow_negative_numbers = true)]
    pub(crate) poisson: Option<f64>,
    /// Density in kg/m^3, in any unit system (default: none is written)
    #[arg(long, value_name = "DENSITY", value_parser = number, allow_negative_numbers = true)]
    pub(crate) density: Option<f64>,
    /// Modulus in Pa that the matrix was made with, where the table's factors are relative to it
    #[arg(long, value_name = "PASCAL", value_parser = number, allow_negative_numbers = true)]
    pub(crate) modulus: Option<f64>,
    /// Values of the best law in a law.json, at every frequency of the table
    #[arg(long, value_name = "LAW.JSON")]
    pub(crate) law: Option<PathBuf>,
    /// Number of the material (Nastran, Ansys); Nastran's tables have it and the next
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) id: u32,
    /// Name of the material (Abaqus)
    #[arg(long, value_name = "NAME", default_value = "FRFIT")]
    pub(crate) name: String,
    /// Every row with a modulus, not only those that are ok
    #[arg(long)]
    pub(crate) all: bool,
    /// Which unknown of a table of several
    #[arg(long, value_name = "NAME")]
    pub(crate) unknown: Option<String>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Overrides {
    /// First and last frequency in Hz, in place of the case's
    #[arg(long, value_name = "FROM:TO", value_parser = band)]
    pub(crate) band: Option<[f64; 2]>,
    /// What factorises the matrices (multifrontal, mumps), in place of the case's
    #[arg(long)]
    pub(crate) engine: Option<String>,
    /// Command that starts the ranks of mumps, such as "srun -n 64"
    #[arg(long, value_name = "COMMAND")]
    pub(crate) launch: Option<String>,
}

impl Overrides {
    /// In place of what the case says.
    pub(crate) fn of_case(&self) -> load::Overrides {
        load::Overrides {
            band_hz: self.band,
            engine: self.engine.clone(),
            launch: self.launch.clone(),
            ..load::Overrides::default()
        }
    }
}

#[derive(Debug, clap::Args)]
pub(crate) struct Respond {
    /// Case file
    pub(crate) case: PathBuf,
    /// Folder for the results (default: beside the case, such as case-response for case.toml)
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Memory that may be used, in MB (by default what is available): a model that needs more is refused
    #[arg(long, value_name = "MB")]
    pub(crate) memory: Option<u64>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Modes {
    /// Case file
    pub(crate) case: PathBuf,
    /// Folder for tables, shapes and figures
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Reduced model of frfit train, for the same matrices, load and sensors
    #[arg(long, value_name = "FILE")]
    pub(crate) reduced: Option<PathBuf>,
    /// Table of results: its moduli in place of the factors of the unknown matrices
    #[arg(long, value_name = "IDENTIFIED.CSV")]
    pub(crate) identified: Option<PathBuf>,
    /// Largest order of the stabilisation diagram, some three for each mode of the band (default: 60)
    #[arg(long, value_name = "N", value_parser = order)]
    pub(crate) max_order: Option<usize>,
    /// Memory that may be used, in MB (by default what is available): a model that needs more is refused
    #[arg(long, value_name = "MB")]
    pub(crate) memory: Option<u64>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Sensitivities {
    /// Case file
    pub(crate) case: PathBuf,
    /// Folder for the table, the summary and the figure
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Reduced model of frfit train, for the same matrices, load and sensors
    #[arg(long, value_name = "FILE")]
    pub(crate) reduced: Option<PathBuf>,
    /// Relative standard deviation of a response, such as 0.02 (default: as the files of all measurements say, else 0.01)
    #[arg(long, value_name = "PART", value_parser = part, allow_negative_numbers = true)]
    pub(crate) noise: Option<f64>,
    /// Where the next sensor may go: all (translations), none, or a list such as 12+Z,55+Z or 41 (a row)
    #[arg(long, value_name = "DOFS", default_value = "all")]
    pub(crate) candidates: Candidates,
    /// Memory that may be used, in MB (by default what is available): a model that needs more is refused
    #[arg(long, value_name = "MB")]
    pub(crate) memory: Option<u64>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Inspect {
    /// Files
    #[arg(required = true)]
    pub(crate) files: Vec<PathBuf>,
    /// Number of the first natural frequencies to print (default 12, if the two files are K and M)
    #[arg(long, value_name = "COUNT")]
    pub(crate) modes: Option<usize>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Convert {
    /// File to read
    pub(crate) input: PathBuf,
    /// File to write; its ending says the format. - for standard output
    pub(crate) output: PathBuf,
    /// Format of the output in place of that of its name, such as mtx or csv
    #[arg(long, value_name = "ENDING")]
    pub(crate) to: Option<String>,
    /// Which matrix of a file of several
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// Which FRFs of a UFF file, from 1, such as 2 or 1,3
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub(crate) record: Vec<i64>,
    /// Names of a table's columns in place of its own, such as frequency_hz,magnitude_db,phase_deg; - for one that is not read
    #[arg(long, value_name = "NAMES", value_delimiter = ',', allow_hyphen_values = true)]
    pub(crate) columns: Option<Vec<String>>,
    /// What a table's FRF is: receptance, mobility or accelerance
    #[arg(long)]
    pub(crate) quantity: Option<frfit::quantity::Quantity>,
    /// Measured degree of freedom, such as 34+Z
    #[arg(long, value_name = "DOF")]
    pub(crate) response: Option<frfit::dof::DofName>,
    /// Driven degree of freedom, such as 12+Z
    #[arg(long, value_name = "DOF")]
    pub(crate) reference: Option<frfit::dof::DofName>,
    /// Binary dataset 58b in place of text
    #[arg(long)]
    pub(crate) binary: bool,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Completions {
    /// bash, zsh, fish, elvish or powershell
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, clap::Args)]
pub(crate) struct Man {
    /// Folder to write them to: frfit.1, and a page for each command
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
}

/// A law, or `all` of them.
#[derive(Debug, Clone)]
pub(crate) struct Laws(pub(crate) Vec<LawKind>);

fn laws(text: &str) -> Result<Laws, UnknownLawKind> {
    if text == "all" { Ok(Laws(LawKind::ALL.to_vec())) } else { Ok(Laws(vec![text.parse()?])) }
}

/// `T=20` as a column and a value.
fn cell(text: &str) -> Result<(String, String), String> {
    let (column, value) = text
        .split_once('=')
        .ok_or_else(|| format!("expected a column and a value such as T=20, found {text:?}"))?;
    Ok((column.trim().to_owned(), value.trim().to_owned()))
}

/// A number, which the options judge.
fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("expected a number such as 0.5, found {text:?}"))
}

/// A part of a whole, above zero.
fn part(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|part| *part > 0.0 && part.is_finite());
    number.ok_or_else(|| format!("expected a number above 0 such as 0.02, found {text:?}"))
}

/// `200:1550` as a band in Hz.
fn band(text: &str) -> Result<[f64; 2], String> {
    let refuse = || format!("expected two frequencies such as 200:1550, found {text:?}");
    let (first, last) = text.split_once(':').ok_or_else(refuse)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| refuse());
    Ok([number(first)?, number(last)?])
}

/// The largest order of a stabilisation diagram: a pole has to be there at three orders, and the cost of an order grows with its cube.
fn order(text: &str) -> Result<usize, String> {
    let refuse = || format!("expected an order from 6 to 400, found {text:?}");
    text.trim().parse().ok().filter(|order| (6..=400).contains(order)).ok_or_else(refuse)
}
