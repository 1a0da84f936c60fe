//! Timing of a solid.
use sparse_ldlt::{Options, Ordering, Symbolic, c64, Scalar};
struct Instant(f64);
impl Instant { fn now()->Self{Self(cpu())} fn elapsed(&self)->std::time::Duration{std::time::Duration::from_secs_f64(cpu()-self.0)} }
fn cpu()->f64{ std::fs::read_to_string("/proc/thread-self/schedstat").unwrap().split(' ').next().unwrap().parse::<f64>().unwrap()/1e9 }
fn run<T: Scalar>(name: &str, dims: [usize;3], value: impl Fn(f64, f64)->T, threads: usize, reps: usize) {
    let [nx,ny,nz]=dims; let nn=nx*ny*nz;
    let mut s=12345u64; let mut noise=move||{s^=s<<13;s^=s>>7;s^=s<<17;(s>>11) as f64/(1u64<<52) as f64-1.0};
    let (mut cp,mut ri,mut v)=(vec![0usize],vec![],vec![]);
    for p in 0..nn { let (x,y,z)=(p/(ny*nz),p/nz%ny,p%nz);
        for d in 0..3 { let col=3*p+d;
            for ex in x..(x+2).min(nx) { for ey in y.saturating_sub(1)..(y+2).min(ny) { for ez in z.saturating_sub(1)..(z+2).min(nz) {
                let q=(ex*ny+ey)*nz+ez; if q<p {continue;}
                for e in 0..3 { let row=3*q+e; if row<col {continue;} ri.push(row); v.push(value(if row==col {8.0} else {0.0}+noise(), 0.05*noise())); } } } }
            cp.push(ri.len()); } }
    let n=3*nn;
    let t=Instant::now(); let sy=Symbolic::new(n,&cp,&ri,&Ordering::Automatic).unwrap(); let ta=t.elapsed().as_secs_f64();
    let mut best=f64::MAX; let mut f=None;
    for _ in 0..reps { f=None; let t=Instant::now(); let g=sy.factor(&v,&Options{threads,..Default::default()}).unwrap(); best=best.min(t.elapsed().as_secs_f64()); f=Some(g); }
    let f=f.unwrap();
    let mut solve=|k:usize|{ let mut best=f64::MAX; for _ in 0..5 { let mut b=vec![T::ONE;n*k]; let t=Instant::now(); f.solve_in_place(&mut b,threads); best=best.min(t.elapsed().as_secs_f64()); } best*1e3};
    let (s1,s8)=(solve(1),solve(8));
    println!("{name} n={n} threads={threads} analyse {ta:.3} flops {:.2} G factor {best:.3} s ({:.1} GF/s) solve1 {s1:.1} ms solve8 {s8:.1} ms bytes {:.0} MB (pred {:.0}, work {:.0}) delayed {} pairs {}", sy.flops()/1e9, sy.flops()*if T::PARTS==2 {4.0} else {1.0}/best/1e9*1.0, f.bytes() as f64/1e6, sy.factor_bytes::<T>() as f64/1e6, sy.working_bytes::<T>() as f64/1e6, f.delayed(), f.pairs());
}
fn main(){
    let a:Vec<String>=std::env::args().collect();
    let d:[usize;3]=[a[1].parse().unwrap(),a[2].parse().unwrap(),a[3].parse().unwrap()]; let th:usize=a[4].parse().unwrap(); let r:usize=a[5].parse().unwrap();
    run("c64",d,c64::new,th,r); run("f64",d,|re,_|re,th,r);
}
