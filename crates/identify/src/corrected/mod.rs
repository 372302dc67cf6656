//! Lines whose substructures have errors, a few side by side: the corrections of each follow the unknowns.
//!
//! As in `objective`, with the many corrections δ of one line replaced by the few motions ζ = M δ of the model that they make. Those that
//! are best are δ = Σ_H Mᵀ λ with λ = J_ζᴴ Σ⁻¹ r̃, so that Σ |δ|²/σ_H² = λᴴ ζ and ζ = Σ_ζ λ: what is known of a line is λ.

mod lines;
mod model;
mod settling;
mod sums;
mod variances;
mod whitening;

use num_complex::Complex64;

use super::group::Group;
use super::kernel::for_dofs;
use super::lanes::LANES;
use super::layout::Place;
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

/// Some consecutive lines of a group, from number `first` on, at the same unknowns.
pub(super) struct Piece<'p> {
    pub(super) group: &'p Group,
    /// Unknown entries of the K* of each joint.
    pub(super) entries: &'p [Place],
    pub(super) unknowns: &'p [f64],
    pub(super) levels: Levels,
    pub(super) first: usize,
}

impl Piece<'_> {
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
}

type Settle = fn(&Piece<'_>, Variances<'_>, &mut [Complex64], &mut Normal) -> Option<f64>;
type Marginal = fn(&Piece<'_>, usize) -> Option<Vec<f64>>;

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
        strip.settle()?;
        strip.give_corrections(own);
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
                *variance = strip.factor[place(e, e)].re.0[lane];
            }
        }
    }
    Some(all)
}
