//! Whole paths that compete with one another.

use super::RIVAL_NATS;
use super::band::{Band, DEFAULT_CURVATURE};
use super::path::{Path, Point};

/// Paths that are compared: a band has no more smooth branches that reach through most of it.
const MAX_RIVAL_PATHS: usize = 6;

/// Nats by which a path that is nowhere is worse than one that is everywhere, all else being equal: one that misses a fifth of what
/// another has is just about excluded. Not the cost of skipping point by point: a wrong branch may well reach further than the
/// part of the right one that was found.
const COVERAGE_NATS: f64 = 40.0;

/// A path through a band.
#[derive(Debug, Clone)]
pub(super) struct Track {
    /// What was there to be chosen: the band without what paths took that cost less or are no material.
    pub(super) band: Band,
    /// The point chosen at each frequency.
    pub(super) chosen: Vec<Option<usize>>,
    /// How badly it does, in nats, comparable with other tracks.
    pub(super) score: f64,
}

impl Track {
    /// The point chosen at a frequency.
    pub(super) fn at(&self, k: usize) -> Option<&Point> {
        self.chosen[k].map(|index| &self.band.points[k][index])
    }

    /// Takes its point out of those at a frequency.
    fn take_from(&self, k: usize, points: &mut Vec<Point>) {
        if let Some(taken) = self.at(k) {
            points.retain(|point| !point.is(taken));
        }
    }

    /// Takes another path, which has none of its points, out of its band.
    fn lose(&mut self, other: &Self) {
        for k in 0..self.chosen.len() {
            let own = self.at(k).copied();
            let points = &mut self.band.points[k];
            other.take_from(k, points);
            self.chosen[k] = own.and_then(|own| points.iter().position(|point| point.node == own.node));
        }
    }

    /// The band with nothing but this path.
    pub(super) fn restricted(&self) -> Band {
        let points = (0..self.chosen.len()).map(|k| self.at(k).copied().into_iter().collect());
        Band { points: points.collect(), log_frequency: self.band.log_frequency.clone() }
    }
}

/// The cheapest path, the cheapest without its points, and so on, best score first; those among them that are better than no path at all by
/// some nats.
pub(super) fn tracks(mut band: Band) -> Vec<Track> {
    let mut tracks: Vec<Track> = Vec::new();
    let occupied = band.occupied() as f64;
    for _ in 0..MAX_RIVAL_PATHS {
        if band.points.iter().all(Vec::is_empty) {
            break;
        }
        let Some((path, chosen)) = band.cheapest(DEFAULT_CURVATURE) else { break };
        let Path { material, misfit, count, .. } = path;
        if count == 0 {
            break;
        }
        let missing = COVERAGE_NATS * (1.0 - count as f64 / occupied);
        let track = Track { score: material + misfit + missing, band: band.clone(), chosen };
        band.points.iter_mut().enumerate().for_each(|(k, points)| track.take_from(k, points));
        // Not the misfit, which where the model has errors of its own is larger than usual for the right path too.
        let is_excluded = |nats: f64| nats >= COVERAGE_NATS - RIVAL_NATS;
        if is_excluded(material) {
            // A smaller curvature must not lead a material's path onto it.
            tracks.iter_mut().for_each(|other| other.lose(&track));
        } else if !is_excluded(material + missing) {
            tracks.push(track);
        }
    }
    tracks.sort_by(|a, b| a.score.total_cmp(&b.score));
    tracks
}
