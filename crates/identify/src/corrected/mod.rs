//! Lines whose substructures have errors, a few side by side: the corrections of each follow the unknowns.
//!
//! As in `objective`, with the many corrections δ of one line replaced by the few motions ζ = M δ of the model that they make. Those that
//! are best are δ = Σ_H Mᵀ λ with λ = J_ζᴴ Σ⁻¹ r̃, so that Σ |δ|²/σ_H² = λᴴ ζ and ζ = Σ_ζ λ: what is known of a line is λ.

mod lines;
mod model;
mod seen;
mod settling;
mod sums;
mod variances;
mod whitening;

use num_complex::Complex64;

use super::group::Group;
use super::kernel::for_dofs;
use super::lanes::LANES;
use super::layout::Place;
use super::line::Line;
use super::motions::place;
use super::noise::Levels;
use super::normal::Normal;
use lines::Corrected;
use sums::Sums;

/// Variances of the entries of some consecutive lines.
pub(super) enum Variances<'w> {
    Held(&'w [f64]),
    /// To be renewed from what is computed at the unknowns.
    Renewed(&'w mut [f64]),
}

/// What of each line is to be seen.
#[derive(Clone, Copy)]
pub(super) enum Seen<'w> {
    /// The residual as it is, and the derivatives by the sources.
    Plain,
    /// The residual whitened by the variances that the levels give.
    Renewed,
    /// The residual whitened by these variances, and the score.
    Score(&'w [f64]),
}

/// Some consecutive lines of a group, from number `first` on, at the same unknowns.
pub(super) struct Piece<'p> {
    pub(super) group: &'p Group,
    /// Unknown entries of the K* of each joint.
    pub(super) entries: &'p [Place],
    pub(super) unknowns: &'p [f64],
    pub(super) levels: Levels,
    pub(super) first: usize,
    /// Whether corrections stay what they are: the structures' receptances are held as they were measured.
    pub(super) holds: bool,
}

impl Piece<'_> {
    /// Joints that are sought.
    fn joints(&self) -> usize {
        self.unknowns.len() / (2 * self.entries.len())
    }

    /// Lets the `corrections` of its lines follow the unknowns and adds the lines, linearised there, to the normal equations. Returns
    /// Σ|y − mean|²/σ² over repeated measurements where variances are renewed; `None` where a line cannot be computed.
    pub(super) fn settle(
        &self,
        variances: Variances<'_>,
        corrections: &mut [Complex64],
        normal: &mut Normal,
    ) -> Option<f64> {
        let settle: Option<Settle> = for_dofs!(self.group.dofs(), settle);
        settle?(self, variances, corrections, normal)
    }

    /// Variances of y − H^C with the substructures as measured, the errors of these included, line by line.
    pub(super) fn marginal_variances(&self, lines: usize) -> Option<Vec<f64>> {
        let marginal: Option<Marginal> = for_dofs!(self.group.dofs(), marginal);
        marginal?(self, lines)
    }

    /// Calls `visit` with each of so many lines as these corrections leave it, the residual being y − H^C as the substructures
    /// were measured.
    pub(super) fn visit(
        &self,
        lines: usize,
        corrections: &[Complex64],
        seen: Seen<'_>,
        visit: &mut dyn FnMut(&Line<'_>),
    ) -> Option<()> {
        let visit_lines: Option<Visit> = for_dofs!(self.group.dofs(), visit_lines);
        visit_lines?(self, lines, corrections, seen, visit)
    }
}

type Settle = fn(&Piece<'_>, Variances<'_>, &mut [Complex64], &mut Normal) -> Option<f64>;
type Marginal = fn(&Piece<'_>, usize) -> Option<Vec<f64>>;
type Visit = fn(&Piece<'_>, usize, &[Complex64], Seen<'_>, &mut dyn FnMut(&Line<'_>)) -> Option<()>;

fn settle<const N: usize>(
    piece: &Piece<'_>,
    mut variances: Variances<'_>,
    corrections: &mut [Complex64],
    normal: &mut Normal,
) -> Option<f64> {
    let group = piece.group;
    let (count, size) = (group.sources.len(), group.entries());
    let mut strip = Corrected::<N>::new(piece);
    let mut sums = Sums::new(piece);
    let mut scatter = 0.0;
    let lines = corrections.len() / count;
    for from in (0..lines).step_by(LANES) {
        let to = lines.min(from + LANES);
        strip.begin(piece.first + from, to - from);
        let own = &mut corrections[from * count..to * count];
        strip.take_corrections(own);
        strip.linearise()?;
        match &mut variances {
            Variances::Held(entries) => strip.take_variances(&entries[from * size..to * size]),
            Variances::Renewed(entries) => {
                scatter += strip.renew_variances(&mut entries[from * size..to * size])?;
            }
        }
        if piece.holds {
            strip.whiten_residual()?;
        } else {
            strip.settle()?;
            strip.give_corrections(own);
        }
        strip.whiten_derivatives();
        sums.add(strip.whitened());
    }
    sums.add_to(normal);
    Some(scatter)
}

fn marginal<const N: usize>(piece: &Piece<'_>, lines: usize) -> Option<Vec<f64>> {
    let size = piece.group.entries();
    let mut strip = Corrected::<N>::new(piece);
    let mut all = vec![0.0; lines * size];
    for from in (0..lines).step_by(LANES) {
        let to = lines.min(from + LANES);
        strip.begin(piece.first + from, to - from);
        strip.linearise()?;
        let own = &mut all[from * size..to * size];
        strip.renew_variances(own)?;
        strip.covariance_of_entries();
        for (lane, of_line) in own.chunks_exact_mut(size).enumerate() {
            for (e, variance) in of_line.iter_mut().enumerate() {
                *variance = strip.factor[place(e, e)].re.lane(lane);
            }
        }
    }
    Some(all)
}

fn visit_lines<const N: usize>(
    piece: &Piece<'_>,
    lines: usize,
    corrections: &[Complex64],
    seen: Seen<'_>,
    visit: &mut dyn FnMut(&Line<'_>),
) -> Option<()> {
    let (count, size) = (piece.group.sources.len(), piece.group.entries());
    let mut strip = Corrected::<N>::new(piece);
    let mut line = Line::new(piece.group);
    let mut renewed = vec![0.0; size * LANES];
    for from in (0..lines).step_by(LANES) {
        let to = lines.min(from + LANES);
        strip.begin(piece.first + from, to - from);
        strip.take_corrections(&corrections[from * count..to * count]);
        strip.linearise()?;
        match seen {
            Seen::Plain => {}
            Seen::Renewed => {
                strip.renew_variances(&mut renewed[..(to - from) * size])?;
            }
            Seen::Score(entries) => {
                strip.take_variances(&entries[from * size..to * size]);
            }
        }
        strip.take_motions_back();
        let relative_power = strip.relative_power();
        if !matches!(seen, Seen::Plain) {
            strip.whiten_what_is_left()?;
        }
        if matches!(seen, Seen::Score(_)) {
            strip.whiten_derivatives();
        }
        for lane in 0..to - from {
            strip.show(lane, relative_power, &mut line);
            match seen {
                Seen::Plain => strip.show_sources(lane, &mut line),
                Seen::Score(_) => strip.show_score(lane, &mut line),
                Seen::Renewed => {}
            }
            visit(&line);
        }
    }
    Some(())
}
