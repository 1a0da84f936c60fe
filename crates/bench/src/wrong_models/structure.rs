//! The structures: plates, beams, sandwiches and beams on springs, with dimensions and supports drawn.

use super::dice::Dice;
use frfit::c64;
use frfit::material::Law;
use frfit_fem::Support::{self, Clamped, Free, Pinned};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt;

/// What kind of structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A rectangular plate of one material, which is unknown.
    Plate,
    /// A beam in bending of one material, which is unknown.
    Beam,
    /// A strip of two known skins on an unknown core, in bricks.
    Sandwich,
    /// A beam of an unknown material on known springs.
    SprungBeam,
    /// A rectangular plate of an orthotropic material, all four constants of which are unknown.
    OrthotropicPlate,
}

impl Kind {
    /// Those with one unknown.
    pub const ALL: [Self; 4] = [Self::Plate, Self::Beam, Self::Sandwich, Self::SprungBeam];
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Plate => "plate",
            Self::Beam => "beam",
            Self::Sandwich => "sandwich",
            Self::SprungBeam => "sprung beam",
            Self::OrthotropicPlate => "orthotropic plate",
        })
    }
}

/// A known spring to the ground.
#[derive(Debug, Clone, Copy)]
pub struct Spring {
    /// Where, as a part of the length; the nearest node of the mesh has it.
    pub at: f64,
    /// Its stiffness in N/m, with its loss.
    pub stiffness: c64,
}

/// A structure with its mesh.
///
/// The plate lies over 0 ≤ x ≤ length, 0 ≤ y ≤ width; beams and strips lie along x.
#[derive(Debug, Clone)]
pub struct Structure {
    /// What kind.
    pub kind: Kind,
    /// Along x in m.
    pub length: f64,
    /// Along y in m.
    pub width: f64,
    /// Thickness in m of each layer: one, or skin, core, skin.
    pub layers: Vec<f64>,
    /// Poisson's ratio of the unknown material.
    pub poisson: f64,
    /// How the edges x = 0, x = length, y = 0, y = width are held; of beams and strips the first two.
    pub edges: [Support; 4],
    /// Springs to the ground.
    pub springs: Vec<Spring>,
    /// Storage modulus of the unknown material in Pa, in the middle of the band.
    pub storage: f64,
    /// D₁₁, D₂₂, D₁₂ and D₆₆ over the storage modulus, of an orthotropic plate.
    pub orthotropy: [f64; 4],
    /// Density of the unknown material in kg/m³.
    pub density: f64,
    /// Modulus in Pa and density in kg/m³ of the skins.
    pub skins: (c64, f64),
    /// Numbers of elements along x and y.
    pub mesh: [usize; 2],
}

/// Skins are of steel or aluminium: modulus in Pa and density in kg/m³.
const SKINS: [(f64, f64); 2] = [(2.1e11, 7850.0), (7.0e10, 2700.0)];

/// Poisson's ratio of the skins.
pub const SKIN_POISSON: f64 = 0.3;

impl Structure {
    /// Draws a structure of a kind. `bricks`: one whose supports bricks have too, and not too thin for them.
    pub fn draw(kind: Kind, bricks: bool, dice: &mut Dice) -> Self {
        let mut drawn = match kind {
            Kind::Plate => Self::plate(bricks, dice),
            Kind::Beam => Self::beam(bricks, dice),
            Kind::Sandwich => Self::sandwich(dice),
            Kind::SprungBeam => Self::sprung(dice),
            Kind::OrthotropicPlate => Self::orthotropic(dice),
        };
        let fine = match kind {
            Kind::Plate => dice.count(10, 16),
            Kind::Beam | Kind::SprungBeam => dice.count(14, 30),
            Kind::Sandwich => dice.count(14, 22),
            Kind::OrthotropicPlate => dice.count(8, 12),
        };
        drawn.set_mesh(fine);
        drawn
    }

    fn plate(bricks: bool, dice: &mut Dice) -> Self {
        let length = dice.between(0.2, 0.8);
        let width = length * dice.between(0.5, 0.95);
        let edges = match dice.below(if bricks { 4 } else { 6 }) {
            0 => [Clamped; 4],
            1 => [Clamped, Free, Free, Free],
            2 => [Free; 4],
            3 => [Clamped, Clamped, Free, Free],
            4 => [Pinned; 4],
            _ => [Pinned, Pinned, Free, Free],
        };
        let thinnest = if bricks { 1.0 / 60.0 } else { 1.0 / 150.0 };
        let layers = vec![width * dice.log_between(thinnest, 1.0 / 25.0)];
        Self { kind: Kind::Plate, length, width, layers, edges, ..Self::metal(dice) }
    }

    fn beam(bricks: bool, dice: &mut Dice) -> Self {
        let length = dice.between(0.2, 1.0);
        let height = length * dice.log_between(1.0 / 80.0, 1.0 / 20.0);
        let [first, last] = match dice.below(if bricks { 3 } else { 4 }) {
            0 => [Free; 2],
            1 => [Clamped, Free],
            2 => [Clamped; 2],
            _ => [Pinned; 2],
        };
        let width = height * dice.between(0.7, 2.0);
        let edges = [first, last, Free, Free];
        Self { kind: Kind::Beam, length, width, layers: vec![height], edges, ..Self::metal(dice) }
    }

    fn sprung(dice: &mut Dice) -> Self {
        let mut beam = Self { kind: Kind::SprungBeam, ..Self::beam(true, dice) };
        beam.edges = [if dice.coin() { Clamped } else { Free }, Free, Free, Free];
        // From felt by the first mode alone to nearly a support.
        let unit = beam.storage * beam.bending() / beam.length.powi(3);
        for _ in 0..dice.count(1, 2) {
            let stiffness =
                c64::new(1.0, dice.between(0.0, 0.05)) * (unit * dice.log_between(300.0, 30_000.0));
            beam.springs.push(Spring { at: dice.between(0.2, 1.0), stiffness });
        }
        beam
    }

    /// From plywood to the wood of a soundboard.
    fn orthotropic(dice: &mut Dice) -> Self {
        let plate = Self::plate(false, dice);
        let (across, poisson) = (dice.log_between(0.05, 0.8), dice.between(0.2, 0.4));
        let twisting = across.sqrt() * dice.between(0.25, 0.5);
        let orthotropy = [1.0, across, poisson * across, twisting];
        Self { kind: Kind::OrthotropicPlate, orthotropy, ..plate }
    }

    fn sandwich(dice: &mut Dice) -> Self {
        let length = dice.between(0.15, 0.4);
        let width = length * dice.between(0.08, 0.2);
        let layers = vec![
            dice.log_between(5e-4, 2.5e-3),
            dice.log_between(2e-4, 3e-3),
            dice.log_between(5e-4, 2.5e-3),
        ];
        let (modulus, density) = dice.pick(&SKINS);
        let skins = (c64::new(modulus, modulus * dice.log_between(5e-4, 5e-3)), density);
        let poisson = dice.between(0.4, 0.45);
        // Shear of the core over stretching of the thinner skin on half of the length: between two loose skins and one thick beam.
        let thinner = layers[0].min(layers[2]);
        let coupling = dice.log_between(0.1, 10.0) * 4.0 / (length * length);
        let storage = 2.0 * (1.0 + poisson) * coupling * modulus * thinner * layers[1];
        let edges = [if dice.uniform() < 0.7 { Clamped } else { Free }, Free, Free, Free];
        let density = dice.between(900.0, 1500.0);
        Self {
            kind: Kind::Sandwich,
            length,
            width,
            layers,
            edges,
            skins,
            poisson,
            storage,
            density,
            ..Self::metal(dice)
        }
    }

    /// Anything from a polymer to steel, not held, without dimensions.
    fn metal(dice: &mut Dice) -> Self {
        Self {
            kind: Kind::Beam,
            length: 1.0,
            width: 1.0,
            layers: Vec::new(),
            poisson: dice.between(0.25, 0.38),
            edges: [Free; 4],
            springs: Vec::new(),
            storage: dice.log_between(1e9, 2.1e11),
            orthotropy: [1.0; 4],
            density: dice.between(1000.0, 8000.0),
            skins: (c64::default(), 0.0),
            mesh: [1; 2],
        }
    }

    /// So many elements along x, and as long ones along y; of strips two along y.
    pub fn set_mesh(&mut self, elements: usize) {
        let across = match self.kind {
            Kind::Plate => self.as_long_across(elements).max(3),
            Kind::OrthotropicPlate => self.as_long_across(elements).max(2),
            Kind::Sandwich => 2,
            Kind::Beam | Kind::SprungBeam => 1,
        };
        self.mesh = [elements, across];
    }

    /// How many elements along y are as long as so many along x.
    fn as_long_across(&self, elements: usize) -> usize {
        (elements as f64 * self.width / self.length).round() as usize
    }

    /// Total thickness in m.
    pub fn thickness(&self) -> f64 {
        self.layers.iter().sum()
    }

    /// Second moment of area about y, in m⁴, of a structure of one layer.
    pub fn bending(&self) -> f64 {
        self.width * self.thickness().powi(3) / 12.0
    }

    /// Mass in kg.
    pub fn mass(&self) -> f64 {
        let per_area = match self.layers.as_slice() {
            [below, core, above] => self.skins.1 * (below + above) + self.density * core,
            layers => self.density * layers.iter().sum::<f64>(),
        };
        self.length * self.width * per_area
    }

    /// Whether an edge is clamped.
    pub fn is_clamped(&self) -> bool {
        self.edges.contains(&Clamped)
    }

    /// The law of the unknown material: E′ as it is in the middle of the band. Of a core a fractional Zener law, whose loss factor has its peak
    /// in the band or beside it; else constant.
    pub fn draw_law(&self, middle_hz: f64, dice: &mut Dice) -> Law {
        if self.kind != Kind::Sandwich {
            return Law::complex_modulus(self.storage, dice.log_between(1e-3, 1.5));
        }
        let peak_hz = middle_hz * dice.log_between(0.2, 5.0);
        let (loss, alpha) = (dice.log_between(0.02, 1.0), dice.between(0.6, 0.95));
        let law = zener(loss, alpha, peak_hz);
        let at_middle = law.at(middle_hz).map_or(1.0, |modulus| modulus.re);
        law.scaled(self.storage / at_middle)
    }
}

/// A fractional Zener law with E₀ = 1 by the peak of its loss factor: its height, the exponent, and where it is.
///
/// At (ωτ)^α = c^{−1/2}, c = E∞/E₀, η is largest: (c − 1) sin θ / (2 √c + (c + 1) cos θ) with θ = απ/2.
///
/// # Limits
/// A height above tan θ has no c; the largest is then that of c = 10⁶.
fn zener(loss: f64, alpha: f64, peak_hz: f64) -> Law {
    let (sin, cos) = (alpha * FRAC_PI_2).sin_cos();
    let height = |c: f64| (c - 1.0) * sin / (2.0 * c.sqrt() + (c + 1.0) * cos);
    let [mut low, mut high] = [0.0, 1e6_f64.ln()];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if height(middle.exp()) < loss { &mut low } else { &mut high }) = middle;
    }
    let c = high.exp();
    Law::FractionalZener { e0: 1.0, e_infinity: c, tau_s: c.powf(-0.5 / alpha) / (TAU * peak_hz), alpha }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frfit::material::loss_factor;

    #[test]
    fn the_loss_factor_peaks_where_and_as_high_as_asked() {
        let law = zener(0.7, 0.8, 300.0);
        let eta = |f: f64| loss_factor(law.at(f).unwrap());
        // Flat at the peak: an error of the height is of second order.
        assert!((eta(300.0) - 0.7).abs() < 1e-9 && eta(330.0) < 0.7 && eta(270.0) < 0.7);
    }

    #[test]
    fn a_core_has_its_storage_modulus_in_the_middle_of_the_band() {
        let mut dice = Dice::new(3, 1);
        let strip = Structure::draw(Kind::Sandwich, false, &mut dice);
        let law = strip.draw_law(200.0, &mut dice);
        assert!((law.at(200.0).unwrap().re / strip.storage - 1.0).abs() < 1e-12);
    }
}
