//! A few lines side by side: what was measured there, and the corrections with which they begin and end.

use num_complex::Complex64;

use super::super::group::Source;
use super::super::kernel::{Small, filled, matrix, vector};
use super::super::lanes::{Complexes, LANES, Number, Reals};
use super::super::motions::place;
use super::super::weights::source_variance_of_lanes;
use super::Piece;

/// One assembly at these lines, as measured and as corrected.
pub(super) struct Member<const N: usize> {
    pub(super) free: [Small<N, Complexes>; 2],
    pub(super) transfer: [Vec<[Complexes; N]>; 2],
    pub(super) own: [Vec<Complexes>; 2],
    /// Q = (I + F K*)⁻¹ H_ks, a column for each point.
    pub(super) q: Vec<[Complexes; N]>,
    /// X = K* Q
    pub(super) x: Vec<[Complexes; N]>,
}

pub(super) const MEASURED: usize = 0;
pub(super) const CORRECTED: usize = 1;

pub(super) struct Corrected<'p, const N: usize> {
    pub(super) piece: &'p Piece<'p>,
    /// The line in each lane; the last one again where there are no more.
    pub(super) index: [usize; LANES],
    pub(super) used: Reals,
    pub(super) omega: Reals,
    pub(super) members: Vec<Member<N>>,
    pub(super) measured: Vec<Complexes>,
    /// σ_C² of each entry.
    pub(super) variances: Vec<Reals>,
    /// σ_H² of each source.
    pub(super) of_sources: Vec<Reals>,
    /// Σ_ζ of each cluster, one after the other.
    pub(super) covariance: Vec<Reals>,
    /// Corrections that the line began with, for each source.
    pub(super) begun: Vec<Complexes>,
    /// What part of these it still has …
    pub(super) part_begun: Reals,
    /// … beside Σ_H Mᵀ λ
    pub(super) pulls: Vec<Complexes>,
    /// ζ at which it is linearised, and Σ|δ|²/σ_H² there.
    pub(super) motions: Vec<Complexes>,
    pub(super) penalty: Reals,
    pub(super) best: Best,
    pub(super) computed: Vec<Complexes>,
    pub(super) residual: Vec<Complexes>,
    pub(super) by_joint: Vec<Complexes>,
    /// J_ζ of each cluster: of each motion its rows.
    pub(super) by_motion: Vec<Complexes>,
    pub(super) weighted: Vec<Complexes>,
    /// Σ, then the lower triangle of its factor.
    pub(super) factor: Vec<Complexes>,
    /// 1/L_ii
    pub(super) reciprocals: Vec<Reals>,
    pub(super) whitened: Vec<Complexes>,
    pub(super) signal: Reals,
}

/// The corrections that are best for a linearised line.
#[derive(Default)]
pub(super) struct Best {
    pub(super) pulls: Vec<Complexes>,
    pub(super) motions: Vec<Complexes>,
    pub(super) penalty: Reals,
    /// Re ζᴴ λ between where it is linearised and there.
    pub(super) cross: Reals,
}

impl<'p, const N: usize> Corrected<'p, N> {
    pub(super) fn new(piece: &'p Piece<'p>) -> Self {
        let group = piece.group;
        let (size, motions) = (group.entries(), group.motions.count());
        let joints = piece.joints();
        let none = |count: usize| vec![Complexes::ZERO; count];
        let members = group.blocks.iter().map(|block| {
            let columns = || vec![[Complexes::ZERO; N]; block.points];
            let free = [[Complexes::ZERO; N]; N];
            Member {
                free: [free; 2],
                transfer: [columns(), columns()],
                own: [none(block.entries.len()), none(block.entries.len())],
                q: columns(),
                x: columns(),
            }
        });
        let clusters = || group.motions.clusters.iter();
        let of_clusters = |of: &dyn Fn(usize, usize) -> usize| -> usize {
            clusters().map(|c| of(c.motions.len(), c.rows.len())).sum()
        };
        Self {
            piece,
            index: [0; LANES],
            used: Reals::ZERO,
            omega: Reals::ZERO,
            members: members.collect(),
            measured: none(size),
            variances: vec![Reals::ZERO; size],
            of_sources: vec![Reals::ZERO; group.sources.len()],
            covariance: vec![Reals::ZERO; of_clusters(&|motions, _| place(motions, 0))],
            begun: none(group.sources.len()),
            part_begun: Reals::ZERO,
            pulls: none(motions),
            motions: none(motions),
            penalty: Reals::ZERO,
            best: Best {
                pulls: none(motions),
                motions: none(motions),
                ..Best::default()
            },
            computed: none(size),
            residual: none(size),
            by_joint: none(size * joints * piece.entries.len()),
            by_motion: none(of_clusters(&|motions, rows| motions * rows)),
            weighted: none(size),
            factor: none(place(size, 0)),
            reciprocals: vec![Reals::ZERO; size],
            whitened: none(size),
            signal: Reals::ZERO,
        }
    }

    /// Begins with so many lines from this one on, without corrections.
    pub(super) fn begin(&mut self, first: usize, count: usize) {
        let group = self.piece.group;
        let index: [usize; LANES] = std::array::from_fn(|lane| first + lane.min(count - 1));
        self.index = index;
        self.used = Reals::of(|lane| if lane < count { 1.0 } else { 0.0 });
        let mut at = 0;
        for (block, member) in group.blocks.iter().zip(&mut self.members) {
            self.omega = Reals::of(|lane| block.omega[index[lane]]);
            let (dofs, size) = (filled::<N>(block.dofs), block.entries.len());
            let free = index.map(|line| block.free_at(line));
            member.free[MEASURED] =
                matrix(dofs, |i, j| Complexes::of(|lane| free[lane][i * dofs + j]));
            let transfer = index.map(|line| block.transfer_at(line));
            for (point, column) in member.transfer[MEASURED].iter_mut().enumerate() {
                *column = vector(dofs, |i| {
                    Complexes::of(|lane| transfer[lane][point * dofs + i])
                });
            }
            for (e, own) in member.own[MEASURED].iter_mut().enumerate() {
                *own = Complexes::of(|lane| block.own[index[lane] * size + e]);
                let measured = |lane: usize| block.measured[index[lane] * size + e];
                self.measured[at + e] = Complexes::of(measured);
            }
            at += size;
        }
        let mut places = index;
        let mut before: Option<&Source> = None;
        for (variance, source) in self.of_sources.iter_mut().zip(&group.sources) {
            if !before.is_some_and(|before| before.has_places_of(source)) {
                places = index.map(|line| source.place(line));
            }
            before = Some(source);
            *variance = source_variance_of_lanes(source, self.piece.levels, (index, places));
        }
        let clusters = group.motions.clusters.iter();
        let sums = clusters.flat_map(|cluster| &cluster.covariance);
        for (covariance, terms) in self.covariance.iter_mut().zip(sums) {
            let mut sum = Reals::ZERO;
            for &(source, share) in terms {
                sum += self.of_sources[source] * Reals::all(share);
            }
            *covariance = sum;
        }
        self.part_begun = Reals::ZERO;
        self.pulls.fill(Complexes::ZERO);
        self.motions.fill(Complexes::ZERO);
        self.penalty = Reals::ZERO;
    }

    /// Begins at these corrections of each source, line by line.
    pub(super) fn take_corrections(&mut self, corrections: &[Complex64]) {
        let (count, last) = (self.begun.len(), self.index[0]);
        let line = self.index.map(|index| index - last);
        self.part_begun = Reals::all(1.0);
        for (s, begun) in self.begun.iter_mut().enumerate() {
            *begun = Complexes::of(|lane| corrections[line[lane] * count + s]);
            let (power, variance) = (begun.norm_sqr(), self.of_sources[s]);
            self.penalty += variance.where_positive(power / variance, Reals::ZERO);
        }
        let shares = &self.piece.group.motions.shares;
        for (motion, shares) in self.motions.iter_mut().zip(shares) {
            for &(source, share) in shares {
                *motion += self.begun[source].scaled(Reals::all(share));
            }
        }
    }

    /// δ of each source as they have become.
    pub(super) fn give_corrections(&mut self, corrections: &mut [Complex64]) {
        let count = self.begun.len();
        let part = self.part_begun;
        let mut moved = vec![Complexes::ZERO; count];
        for (pull, shares) in self.pulls.iter().zip(&self.piece.group.motions.shares) {
            for &(source, share) in shares {
                moved[source] += pull.scaled(Reals::all(share));
            }
        }
        for (s, moved) in moved.iter().enumerate() {
            let all = self.begun[s].scaled(part) + moved.scaled(self.of_sources[s]);
            for (lane, of_line) in corrections.chunks_exact_mut(count).enumerate() {
                of_line[s] = all.lane(lane);
            }
        }
    }
}
