//! Functions of other languages: Intel MKL, loaded at run time, and the C library's allocator.
#![allow(unsafe_code)]
// MKL is proprietary and has no binding that loads at run time: its functions can only be called through pointers whose types
// nobody checks. The signatures below are those of mkl.h (LP64: integers of 32 bits). Each call gets slices whose lengths are
// asserted here, so that no function of this file can be called into undefined behaviour from outside.

use super::super::case::Number;
use libloading::os::unix::{Library, RTLD_GLOBAL, RTLD_NOW};
use std::ffi::{c_char, c_double, c_int, c_void};
use std::path::Path;

/// PARDISO's integer parameters and its handle: fixed lengths of the interface.
const LENGTH: usize = 64;

type Pardiso = unsafe extern "C" fn(
    *mut c_void,   // pt
    *const c_int,  // maxfct
    *const c_int,  // mnum
    *const c_int,  // mtype
    *const c_int,  // phase
    *const c_int,  // n
    *const c_void, // a
    *const c_int,  // ia
    *const c_int,  // ja
    *mut c_int,    // perm
    *const c_int,  // nrhs
    *mut c_int,    // iparm
    *const c_int,  // msglvl
    *mut c_void,   // b
    *mut c_void,   // x
    *mut c_int,    // error
);
type Init = unsafe extern "C" fn(*mut c_void, *const c_int, *mut c_int);
type Dgemm = unsafe extern "C" fn(
    c_int,
    c_int,
    c_int,
    c_int,
    c_int,
    c_int,
    c_double,
    *const c_double,
    c_int,
    *const c_double,
    c_int,
    c_double,
    *mut c_double,
    c_int,
);
type Zgemm = unsafe extern "C" fn(
    c_int,
    c_int,
    c_int,
    c_int,
    c_int,
    c_int,
    *const c_void,
    *const c_void,
    c_int,
    *const c_void,
    c_int,
    *const c_void,
    *mut c_void,
    c_int,
);

/// MKL with Intel's threads.
pub struct Mkl {
    pardiso: Pardiso,
    pardisoinit: Init,
    set_num_threads: unsafe extern "C" fn(c_int),
    free_buffers: unsafe extern "C" fn(),
    dgemm: Dgemm,
    zgemm: Zgemm,
    /// What it says it is.
    pub version: String,
}

impl Mkl {
    /// Loads libmkl_rt and Intel's OpenMP from a folder; they stay loaded.
    ///
    /// # Errors
    /// What is missing.
    pub fn load(folder: &Path) -> Result<Self, String> {
        let open = |prefix: &str| {
            let found = std::fs::read_dir(folder)
                .map_err(|error| format!("{}: {error}", folder.display()))?
                .flatten()
                .map(|entry| entry.path())
                .find(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(prefix)));
            let path = found.ok_or_else(|| format!("no {prefix}* in {}", folder.display()))?;
            // SAFETY: initialisers of MKL and OpenMP have no requirements; global, because MKL finds its parts by symbol.
            unsafe { Library::open(Some(&path), RTLD_NOW | RTLD_GLOBAL) }.map_err(|error| error.to_string())
        };
        // Before MKL, which looks for it by name only.
        let omp = open("libiomp5.so")?;
        let mkl = open("libmkl_rt.so")?;
        /// A function by its name.
        fn get<F: Copy>(library: &Library, name: &str) -> Result<F, String> {
            // SAFETY: the type F is that of mkl.h, see above; the library is never closed.
            unsafe { library.get::<F>(name.as_bytes()) }.map(|f| *f).map_err(|error| error.to_string())
        }
        let set_layer: unsafe extern "C" fn(c_int) -> c_int = get(&mkl, "MKL_Set_Threading_Layer")?;
        let set_dynamic: unsafe extern "C" fn(c_int) = get(&mkl, "MKL_Set_Dynamic")?;
        let version: unsafe extern "C" fn(*mut c_char, c_int) = get(&mkl, "MKL_Get_Version_String")?;
        let mut text = [0u8; 200];
        // SAFETY: the layer is set before any other call, as MKL wants it (0: Intel); text is as long as is said.
        unsafe {
            set_layer(0);
            // As many threads as are asked for, whatever else runs.
            set_dynamic(0);
            version(text.as_mut_ptr().cast(), 200);
        }
        let version = String::from_utf8_lossy(&text).trim_end_matches(['\0', ' ']).to_owned();
        let loaded = Self {
            pardiso: get(&mkl, "pardiso")?,
            pardisoinit: get(&mkl, "pardisoinit")?,
            set_num_threads: get(&mkl, "MKL_Set_Num_Threads")?,
            free_buffers: get(&mkl, "MKL_Free_Buffers")?,
            dgemm: get(&mkl, "cblas_dgemm")?,
            zgemm: get(&mkl, "cblas_zgemm")?,
            version,
        };
        std::mem::forget((omp, mkl));
        Ok(loaded)
    }

    /// From now on so many threads.
    pub fn set_threads(&self, threads: usize) {
        // SAFETY: a number.
        unsafe { (self.set_num_threads)(threads as c_int) }
    }

    /// Gives back what MKL keeps for later calls.
    pub fn free_buffers(&self) {
        // SAFETY: no other call of MKL is under way: it is called from the main thread only.
        unsafe { (self.free_buffers)() }
    }

    /// C ← A B of n × n matrices.
    ///
    /// # Panics
    /// Where a length is not n².
    pub fn multiply<T: Number>(&self, n: usize, a: &[T], b: &[T], c: &mut [T]) {
        assert!([a.len(), b.len(), c.len()] == [n * n; 3]);
        // Column major, not transposed: the values of cblas.h.
        let (order, not, n) = (102, 111, n as c_int);
        let (one, zero) = ([1.0, 0.0], [0.0, 0.0]);
        let (a, b, c) = (a.as_ptr(), b.as_ptr(), c.as_mut_ptr());
        // SAFETY: three n × n matrices, c not shared; T is f64 or two f64, as its name says.
        unsafe {
            match T::NAME {
                "real" => {
                    (self.dgemm)(order, not, not, n, n, n, 1.0, a.cast(), n, b.cast(), n, 0.0, c.cast(), n)
                }
                _ => (self.zgemm)(
                    order,
                    not,
                    not,
                    n,
                    n,
                    n,
                    one.as_ptr().cast(),
                    a.cast(),
                    n,
                    b.cast(),
                    n,
                    zero.as_ptr().cast(),
                    c.cast(),
                    n,
                ),
            }
        }
    }
}

/// A matrix in PARDISO's hands: upper triangle by rows, from 0; freed when dropped.
pub struct Handle<'a, T> {
    mkl: &'a Mkl,
    handle: [*mut c_void; LENGTH],
    /// Parameters and reports, from 0 as in C.
    pub iparm: [c_int; LENGTH],
    mtype: c_int,
    row_ptr: Vec<c_int>,
    col_idx: Vec<c_int>,
    values: &'a [T],
}

impl<'a, T: Number> Handle<'a, T> {
    /// PARDISO's defaults for symmetric indefinite or complex symmetric matrices.
    ///
    /// # Panics
    /// Where the three do not describe a matrix: an upper triangle by rows with every diagonal entry.
    pub fn new(mkl: &'a Mkl, row_ptr: &[usize], col_idx: &[usize], values: &'a [T]) -> Self {
        let n = row_ptr.len() - 1;
        assert!(
            row_ptr[0] == 0
                && row_ptr.windows(2).all(|pair| pair[0] < pair[1])
                && row_ptr[n] == col_idx.len()
        );
        assert!(col_idx.len() == values.len() && i32::try_from(values.len()).is_ok());
        assert!((0..n).all(|row| {
            let columns = &col_idx[row_ptr[row]..row_ptr[row + 1]];
            columns[0] == row
                && columns.windows(2).all(|pair| pair[0] < pair[1])
                && columns[columns.len() - 1] < n
        }));
        let narrow = |of: &[usize]| of.iter().map(|&k| k as c_int).collect();
        let mtype = if T::real(values).is_some() { -2 } else { 6 };
        let mut new = Self {
            mkl,
            handle: [std::ptr::null_mut(); LENGTH],
            iparm: [0; LENGTH],
            mtype,
            row_ptr: narrow(row_ptr),
            col_idx: narrow(col_idx),
            values,
        };
        // SAFETY: handle and iparm have the 64 places of the interface.
        unsafe { (mkl.pardisoinit)(new.handle.as_mut_ptr().cast(), &new.mtype, new.iparm.as_mut_ptr()) }
        new.iparm[34] = 1; // indices from 0
        new
    }

    /// One phase: 11 analyses, 22 factorises.
    ///
    /// # Errors
    /// PARDISO's number of the error.
    pub fn phase(&mut self, phase: c_int) -> Result<(), c_int> {
        assert!(phase == 11 || phase == 22);
        self.call(phase, 1, &mut [], &mut [])
    }

    /// Phase 33: x = A⁻¹ b for all columns.
    ///
    /// # Errors
    /// PARDISO's number of the error.
    ///
    /// # Panics
    /// Where the lengths are not the same multiple of n.
    pub fn solve(&mut self, b: &mut [T], x: &mut [T]) -> Result<(), c_int> {
        let n = self.row_ptr.len() - 1;
        assert!(b.len() == x.len() && b.len().is_multiple_of(n) && !b.is_empty());
        self.call(33, b.len() / n, b, x)
    }

    fn call(&mut self, phase: c_int, columns: usize, b: &mut [T], x: &mut [T]) -> Result<(), c_int> {
        let (one, silent, n) = (1, 0, (self.row_ptr.len() - 1) as c_int);
        let (columns, mut error) = (columns as c_int, 0);
        // SAFETY: the matrix was checked when it was taken over; b and x hold n × columns numbers in phase 33, the only one
        // that looks at them; a phase out of turn is an error of PARDISO, not undefined; perm is not read with iparm[4] = 0.
        unsafe {
            (self.mkl.pardiso)(
                self.handle.as_mut_ptr().cast(),
                &one,
                &one,
                &self.mtype,
                &phase,
                &n,
                self.values.as_ptr().cast(),
                self.row_ptr.as_ptr(),
                self.col_idx.as_ptr(),
                std::ptr::null_mut(),
                &columns,
                self.iparm.as_mut_ptr(),
                &silent,
                b.as_mut_ptr().cast(),
                x.as_mut_ptr().cast(),
                &mut error,
            );
        }
        if error == 0 { Ok(()) } else { Err(error) }
    }
}

impl<T> Drop for Handle<'_, T> {
    fn drop(&mut self) {
        let (one, zero, free, n, mut error) = (1, 0, -1, (self.row_ptr.len() - 1) as c_int, 0);
        let none = std::ptr::null_mut();
        // SAFETY: phase −1 frees what the handle holds, and reads nothing else.
        unsafe {
            (self.mkl.pardiso)(
                self.handle.as_mut_ptr().cast(),
                &one,
                &one,
                &self.mtype,
                &free,
                &n,
                none,
                self.row_ptr.as_ptr(),
                self.col_idx.as_ptr(),
                std::ptr::null_mut(),
                &zero,
                self.iparm.as_mut_ptr(),
                &zero,
                none,
                none,
                &mut error,
            );
        }
        self.mkl.free_buffers();
    }
}

/// Gives freed memory back to the system, where the C library can: what one solver freed would hide what the next one takes.
pub fn trim_memory() {
    let this = Library::this();
    // SAFETY: malloc_trim(size_t) of the GNU C library, which is safe to call at any time; elsewhere the name is not there.
    unsafe {
        if let Ok(trim) = this.get::<unsafe extern "C" fn(usize) -> c_int>(b"malloc_trim") {
            trim(0);
        }
    }
}
