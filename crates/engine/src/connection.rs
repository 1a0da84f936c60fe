//! The socket to rank 0, and the process that holds the ranks: whichever ends first ends the other.

use crate::job::Job;
use crate::protocol::{FOLDER, OUTCOME, Outcome, RankUsage, Request, Verb, Wire, at};
use frfit_linalg::solve::Breakdown;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// How often a wait looks whether the ranks are still there.
pub(crate) const LOOK: Duration = Duration::from_millis(200);
/// How long ranks may take to end without being killed.
const END: Duration = Duration::from_secs(5);
/// Numbers that are turned into bytes at a time.
const PIECE: usize = 1 << 16;

/// A client's side of the protocol.
#[derive(Debug)]
pub(crate) struct Connection {
    stream: TcpStream,
    job: Job,
    /// Why nothing can be asked any more.
    failed: Option<Breakdown>,
    /// How many patterns and factors there were.
    named: u32,
}

impl Connection {
    pub(crate) fn new(stream: TcpStream, job: Job) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(LOOK))?;
        stream.set_write_timeout(Some(LOOK))?;
        Ok(Self { stream, job, failed: None, named: 0 })
    }

    /// A number that no other pattern or factor has.
    pub(crate) fn name(&mut self) -> u32 {
        self.named += 1;
        self.named
    }

    /// Where factors are kept out of core.
    pub(crate) fn settings(&mut self, folder: &[u8; FOLDER]) -> Result<(), Breakdown> {
        self.ask(Request::new(Verb::Settings), |stream| stream.send(folder))?.check().map(|_| ())
    }

    pub(crate) fn pattern(
        &mut self,
        request: Request,
        arrays: [&mut dyn Iterator<Item = u32>; 3],
    ) -> Result<(), Breakdown> {
        let send = |to: &mut Watched<'_>| arrays.into_iter().try_for_each(|array| to.send_all(array));
        self.ask(request, send)?.check().map(|_| ())
    }

    /// What a factor needs, and what is free there: negative where the machine does not say.
    pub(crate) fn forecast(&mut self, request: Request) -> Result<(Outcome, i64), Breakdown> {
        let outcome = self.ask(request, |_| Ok(()))?;
        let mut available = [0; 8];
        self.guarded(|stream| stream.receive(&mut available))?;
        Ok((outcome.check()?, at(&available, 0)))
    }

    pub(crate) fn factor<T: Wire>(&mut self, request: Request, values: &[T]) -> Result<Outcome, Breakdown> {
        self.ask(request, |stream| stream.send_all(&mut values.iter().copied()))?.check()
    }

    pub(crate) fn solve<T: Wire>(&mut self, request: Request, block: &mut [T]) -> Result<(), Breakdown> {
        self.ask(request, |stream| stream.send_all(&mut block.iter().copied()))?.check()?;
        self.guarded(|stream| stream.receive_all(block))
    }

    pub(crate) fn forget(&mut self, request: Request) -> Result<(), Breakdown> {
        self.ask(request, |_| Ok(())).map(|_| ())
    }

    pub(crate) fn usage(&mut self, ranks: usize) -> Result<Vec<RankUsage>, Breakdown> {
        let mut bytes = vec![0; 16 * ranks];
        self.guarded(|stream| {
            stream.send(&Request::new(Verb::Usage).bytes())?;
            stream.receive(&mut bytes)
        })?;
        let of = |bytes: &[u8]| RankUsage { peak_bytes: at(bytes, 0), cpu_s: at(bytes, 8) };
        Ok(bytes.chunks_exact(16).map(of).collect())
    }

    fn ask(
        &mut self,
        request: Request,
        send: impl FnOnce(&mut Watched<'_>) -> io::Result<()>,
    ) -> Result<Outcome, Breakdown> {
        let mut outcome = [0; OUTCOME];
        self.guarded(|stream| {
            stream.send(&request.bytes())?;
            send(stream)?;
            stream.receive(&mut outcome)
        })?;
        Ok(Outcome::of(&outcome))
    }

    /// A failure in the middle of a request leaves nothing that could be asked again.
    fn guarded(&mut self, work: impl FnOnce(&mut Watched<'_>) -> io::Result<()>) -> Result<(), Breakdown> {
        if let Some(failed) = &self.failed {
            return Err(failed.clone());
        }
        let worked = work(&mut Watched { stream: &mut self.stream, job: &mut self.job });
        worked.map_err(|error| {
            self.job.end(END);
            let words = self.job.words();
            let words = if words.is_empty() { error.to_string() } else { words };
            let failed = Breakdown::Engine(format!("mumps: the ranks have ended: {words}"));
            self.failed.insert(failed).clone()
        })
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        if self.failed.is_none() {
            let _ = self.stream.write_all(&Request::new(Verb::End).bytes());
        }
        self.job.end(END);
    }
}

/// The socket, with a look at the ranks whenever it waits.
struct Watched<'a> {
    stream: &'a mut TcpStream,
    job: &'a mut Job,
}

impl Watched<'_> {
    /// The count of bytes that went through; 0 where it has to be tried again.
    fn patient(&mut self, moved: io::Result<usize>) -> io::Result<usize> {
        match moved {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => Ok(count),
            Err(error) => match error.kind() {
                ErrorKind::Interrupted => Ok(0),
                ErrorKind::WouldBlock | ErrorKind::TimedOut if !self.job.has_ended() => Ok(0),
                _ => Err(error),
            },
        }
    }

    fn send(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            let moved = self.stream.write(bytes);
            bytes = &bytes[self.patient(moved)?..];
        }
        Ok(())
    }

    fn receive(&mut self, mut bytes: &mut [u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            let moved = self.stream.read(bytes);
            bytes = &mut bytes[self.patient(moved)?..];
        }
        Ok(())
    }

    fn send_all<T: Wire>(&mut self, numbers: &mut (impl Iterator<Item = T> + ?Sized)) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(PIECE * T::BYTES);
        loop {
            bytes.clear();
            (&mut *numbers).take(PIECE).for_each(|number| number.put(&mut bytes));
            if bytes.is_empty() {
                return Ok(());
            }
            self.send(&bytes)?;
        }
    }

    fn receive_all<T: Wire>(&mut self, numbers: &mut [T]) -> io::Result<()> {
        let mut bytes = vec![0; PIECE.min(numbers.len()) * T::BYTES];
        for piece in numbers.chunks_mut(PIECE) {
            let bytes = &mut bytes[..piece.len() * T::BYTES];
            self.receive(bytes)?;
            piece
                .iter_mut()
                .zip(bytes.chunks_exact(T::BYTES))
                .for_each(|(number, from)| *number = T::get(from));
        }
        Ok(())
    }
}
