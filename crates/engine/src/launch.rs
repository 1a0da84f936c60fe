//! The command that starts the ranks, and what can be wrong with it.

use crate::connection::{Connection, LOOK};
use crate::job::Job;
use crate::protocol::{FOLDER, GREETING, TOKEN, VERSION, at};
use std::fmt;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How long the ranks may take to call, unless [`Launch::patience`] says otherwise: a cluster may let a job wait.
const PATIENCE: Duration = Duration::from_secs(300);
/// How long a caller may take to show its token.
const GREETING_PATIENCE: Duration = Duration::from_secs(10);

/// How the ranks are started.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Launch {
    /// The launcher and its arguments: `["mpirun", "-n", "3"]`. The program is put after them.
    pub command: Vec<String>,
    /// The program that the ranks run: a path, or a name that the launcher looks for. Default `frfit-mumps`.
    pub program: PathBuf,
    /// The name of this machine, where rank 0 runs on another one. `None`: rank 0 is on this machine, and no other can connect.
    pub host: Option<String>,
    /// A folder of each rank's machine for factors that are kept on disk. `None`: in memory.
    pub out_of_core: Option<PathBuf>,
    /// How long the ranks may take to call. Default 300 s.
    pub patience: Duration,
}

/// Why there are no ranks.
#[derive(Debug)]
#[non_exhaustive]
pub enum StartError {
    /// There is no launcher.
    Empty,
    /// The launcher cannot be run.
    Command {
        /// Its name.
        launcher: String,
        /// Why.
        error: io::Error,
    },
    /// This machine gives no port.
    Port(io::Error),
    /// The job ended before it called; its words.
    Ended(String),
    /// It did not call in time.
    Late(Duration),
    /// It speaks another version of the protocol.
    Version(u32),
    /// The path of the folder for factors is longer than MUMPS takes.
    Folder(PathBuf),
    /// It called, and failed then.
    Failed(String),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "expected a command that starts the ranks, found an empty text"),
            Self::Command { launcher, error } => write!(f, "{launcher:?} cannot be run: {error}"),
            Self::Port(error) => write!(f, "no port of this machine can be used: {error}"),
            Self::Ended(words) if words.is_empty() => write!(f, "the ranks ended before they were ready"),
            Self::Ended(words) => write!(f, "the ranks ended before they were ready: {words}"),
            Self::Late(time) => write!(f, "the ranks did not start within {} s", time.as_secs()),
            Self::Version(found) => {
                write!(
                    f,
                    "expected version {VERSION} of the protocol of frfit-mumps, found {found}: build it anew"
                )
            }
            Self::Folder(folder) => {
                let length = folder.as_os_str().len();
                write!(f, "expected a folder with a path of at most {} bytes, found {length}", FOLDER - 1)
            }
            Self::Failed(words) => write!(f, "{words}"),
        }
    }
}

impl std::error::Error for StartError {}

/// What the ranks say first.
pub(crate) struct Greeting {
    pub(crate) ranks: usize,
    pub(crate) version: String,
}

impl Launch {
    /// A launcher with its arguments, divided by spaces: `mpirun -n 3`, `srun -n 64`.
    pub fn by(command: &str) -> Self {
        Self {
            command: command.split_whitespace().map(str::to_owned).collect(),
            program: "frfit-mumps".into(),
            host: None,
            out_of_core: None,
            patience: PATIENCE,
        }
    }

    pub(crate) fn start(&self) -> Result<(Connection, Greeting), StartError> {
        let folder = self.folder()?;
        let [launcher, arguments @ ..] = self.command.as_slice() else { return Err(StartError::Empty) };
        let address = if self.host.is_some() { "0.0.0.0:0" } else { "127.0.0.1:0" };
        let listener = TcpListener::bind(address).map_err(StartError::Port)?;
        listener.set_nonblocking(true).map_err(StartError::Port)?;
        let port = listener.local_addr().map_err(StartError::Port)?.port();
        let token = token();
        let mut command = Command::new(launcher);
        command.args(arguments).arg(&self.program);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        for threads in ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"] {
            if std::env::var_os(threads).is_none() {
                command.env(threads, "1"); // ranks share the cores among themselves
            }
        }
        let refused = |error| StartError::Command { launcher: launcher.clone(), error };
        let mut job = Job::of(command.spawn().map_err(refused)?);
        // On standard input, which other users of the machine cannot see, as they can see arguments.
        let line = format!("{} {port} {token}\n", self.host.as_deref().unwrap_or("127.0.0.1"));
        if let Some(input) = &mut job.child.stdin {
            let _ = input.write_all(line.as_bytes()); // a job that has ended already says why in its words
        }
        let called = self.caller(&listener, &token, &mut job);
        let (stream, greeting) = called.inspect_err(|_| job.end(Duration::ZERO))?;
        let mut connection = Connection::new(stream, job).map_err(StartError::Port)?;
        connection.settings(&folder).map_err(|failed| StartError::Failed(failed.to_string()))?;
        Ok((connection, greeting))
    }

    fn folder(&self) -> Result<[u8; FOLDER], StartError> {
        let mut bytes = [0; FOLDER];
        if let Some(folder) = &self.out_of_core {
            let given = folder.as_os_str().as_encoded_bytes();
            if given.len() >= FOLDER {
                return Err(StartError::Folder(folder.clone()));
            }
            bytes[..given.len()].copy_from_slice(given);
        }
        Ok(bytes)
    }

    /// The first caller with the right token.
    fn caller(
        &self,
        listener: &TcpListener,
        token: &str,
        job: &mut Job,
    ) -> Result<(TcpStream, Greeting), StartError> {
        let start = Instant::now();
        loop {
            match listener.accept() {
                Ok((stream, _)) => match greeting(&stream, token) {
                    Some((VERSION, greeting)) => return Ok((stream, greeting)),
                    Some((other, _)) => return Err(StartError::Version(other)),
                    None => {} // somebody else
                },
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    if job.has_ended() {
                        return Err(StartError::Ended(job.words()));
                    }
                    if start.elapsed() > self.patience {
                        return Err(StartError::Late(self.patience));
                    }
                    std::thread::sleep(LOOK / 20);
                }
                Err(error) => return Err(StartError::Port(error)),
            }
        }
    }
}

/// The version and what else a caller says, if it has the token.
fn greeting(stream: &TcpStream, token: &str) -> Option<(u32, Greeting)> {
    stream.set_nonblocking(false).ok()?;
    stream.set_read_timeout(Some(GREETING_PATIENCE)).ok()?;
    let mut bytes = [0; GREETING];
    { stream }.read_exact(&mut bytes).ok()?;
    let (shown, said) = bytes.split_at(TOKEN);
    let version = said[8..].split(|&byte| byte == 0).next().unwrap_or_default();
    let greeting = Greeting {
        ranks: at::<u32>(said, 4) as usize,
        version: String::from_utf8_lossy(version).chars().filter(|one| !one.is_control()).collect(),
    };
    (shown == token.as_bytes()).then_some((at(said, 0), greeting))
}

/// 256 bits that nobody can guess: the keys of the standard library's hash maps are the system's random numbers.
fn token() -> String {
    (0..4).map(|_| format!("{:016x}", RandomState::new().build_hasher().finish())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_as_long_as_the_greeting_says_and_never_the_same() {
        let tokens = [token(), token()];
        assert!(tokens.iter().all(|token| token.len() == TOKEN));
        assert_ne!(tokens[0], tokens[1]);
    }

    #[test]
    fn a_launcher_is_divided_by_spaces() {
        assert_eq!(Launch::by(" srun  -n 64 ").command, ["srun", "-n", "64"]);
    }
}
