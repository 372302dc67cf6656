//! What a reader should know before using a predicted joint.

use super::check::ContactInputs;
use super::law::Layer;
use super::prediction::Prediction;
use crate::patch::LossFactor;
use crate::pressure::Element;

/// An imbalance of field and preloads that is worth a word.
const IMBALANCE: f64 = 0.01;
/// Real over nominal area from which contacts are no longer apart, as the model has them.
const CROWDED: f64 = 0.1;
/// Loss factor that no joint in one piece has.
const LOSSY: f64 = 1.0;
/// Error of the heat of the law that stands for patches, r.m.s., that is worth a word.
const FAR_FROM_PATCHES: f64 = 0.2;
/// Share of refused draws from which the intervals are those of another distribution.
const REFUSED: f64 = 0.05;

/// An interface that is longer, m, has its lengths in another unit.
const LONG_M: f64 = 3.0;
/// Coefficient of friction that no two solids under a bolt have.
const ROUGH: f64 = 1.5;

impl Prediction<'_> {
    /// An interface as long as a house is one in millimetres.
    fn of_size(&self) -> Option<String> {
        let elements = self.study.geometry.elements();
        let span = |of: &dyn Fn(&Element) -> f64| {
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let ends = elements.iter().fold(ends, |[low, high], own| {
                [low.min(of(own)), high.max(of(own))]
            });
            ends[1] - ends[0]
        };
        let long_m = span(&|own| own.x_m).max(span(&|own| own.y_m));
        (long_m > LONG_M).then(|| {
            format!(
                "the interface is about {long_m:.0} m long: lengths are in m, and these are probably in mm; a bolted interface has some \
                 centimetres"
            )
        })
    }

    fn of_friction(&self) -> Option<String> {
        let ContactInputs::Fractal { friction, .. } = self.study.contact else {
            return None;
        };
        let coefficient = self.study.inputs.nominal().of(friction);
        (coefficient > ROUGH).then(|| {
            format!(
                "contact.friction is {coefficient}: metals have 0.1 to 0.8; check its decimal point, and that it is not in per cent"
            )
        })
    }

    /// A layer that is stiffer than what it takes the place of.
    fn of_layer(&self, layer: &Layer, at: &str) -> Option<String> {
        let ContactInputs::Layer { layers, .. } = self.study.contact else {
            return None;
        };
        let values = self.study.inputs.nominal();
        let [a, b] = &self.study.materials;
        // the slices in series: h/E = h₁/E₁ + h₂/E₂
        let compliances = [a, b].into_iter().zip(layers.thickness_m);
        let compliance: f64 = compliances
            .map(|(part, thickness_m)| thickness_m / values.of(part.youngs_modulus))
            .sum();
        let parts_pa = layer.thickness_m / compliance;
        let found_pa = layer.moduli.youngs_modulus_pa;
        (found_pa > parts_pa).then(|| {
            format!(
                "the layer is stiffer than the parts{at}: its E = {found_pa:.3e} Pa, that of the slices in its place {parts_pa:.3e} Pa. The \
                 model adds up its contacts and divides by no area, so that the moduli go with the whole load; a greater hardness makes \
                 them larger still. Take method = \"fractal-contact\", or a fractal dimension and a roughness that were fitted to measured \
                 moduli"
            )
        })
    }

    /// Warnings, a sentence each; none where all is well.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        warnings.extend(self.of_size());
        warnings.extend(self.of_friction());
        for share in self.study.geometry.shares() {
            if share.part_on_plate < 1.0 - IMBALANCE {
                warnings.push(share.to_string());
            }
        }
        for state in &self.states {
            let at = state
                .torque_n_m
                .map(|torque| format!(" at {torque} N·m"))
                .unwrap_or_default();
            if let Some(balance) = &state.balance
                && balance.force_imbalance().abs() > IMBALANCE
            {
                warnings.push(format!(
                    "{balance}{at}: the pressures belong to other preloads"
                ));
            }
            let crowded = state.largest_real_area();
            if crowded > CROWDED {
                warnings.push(format!(
                    "up to {:.0} % of the area touches{at}: the model has contacts far apart, about 1 %",
                    100.0 * crowded
                ));
            }
            for (direction, loss_factor) in [
                ("normal", state.interface.normal_loss_factor()),
                ("tangential", state.interface.tangential_loss_factor()),
            ] {
                if loss_factor > LOSSY {
                    let as_published = match self.study.loss_factor {
                        LossFactor::EnergyRatio => {
                            ", or take the energy ratio over 2π (damping.loss_factor)"
                        }
                        LossFactor::EnergyRatioOverTwoPi => "",
                    };
                    warnings.push(format!(
                        "the {direction} loss factor is {loss_factor:.2}{at}: more is lost in a cycle than a spring can give back; \
                         check roughness and hardness{as_published}"
                    ));
                }
            }
            let [normal, tangential] = [
                state.interface.normal_loss_factor(),
                state.interface.tangential_loss_factor(),
            ];
            if let Some(layer) = &state.layer
                && let Err(reason) = &layer.material
            {
                warnings.push(format!(
                    "no isotropic material stands for the layer{at}: {reason}"
                ));
            }
            let layer = state.layer.as_ref();
            warnings.extend(layer.and_then(|layer| self.of_layer(layer, &at)));
            if state.layer.is_some() && normal + tangential == 0.0 {
                warnings.push(format!(
                    "the layer has no damping{at}: its model gives none; state layer.loss_factor"
                ));
            }
            for slip in &state.slips {
                let fitted = &slip.fitted;
                let all_slips = slip.patches.slips_through_at();
                if fitted.amplitudes.from >= all_slips {
                    warnings.push(format!(
                        "all of {} slips from {all_slips:.2e} {unit} on{at}, and the law is fitted from {:.2e} to {:.2e} {unit}: how it begins to \
                         slip is arbitrary, and smaller motion has a wrong heat; state smaller amplitudes in {unit} (microslip.amplitudes), \
                         or none",
                        slip.dof.name,
                        fitted.amplitudes.from,
                        fitted.amplitudes.to,
                        unit = slip.dof.kind.displacement_unit()
                    ));
                }
                if fitted.heat_error > FAR_FROM_PATCHES {
                    warnings.push(format!(
                        "the law for the slip of {} misses the heat of its patches by {:.0} % r.m.s.{at}: state the amplitudes that matter \
                         (microslip.amplitudes)",
                        slip.dof.name,
                        100.0 * fitted.heat_error
                    ));
                }
            }
            if state.interface.stiffness[2][2] == 0.0 {
                warnings.push(format!(
                    "no contact is elastic{at}, so that there is no stiffness: the roughness is too large for this pressure and hardness"
                ));
            }
        }
        if let Some(outcome) = &self.outcome
            && outcome.refused_share() > 0.0
        {
            let reasons = outcome.refused.iter();
            let reasons: Vec<String> = reasons
                .map(|(reason, count)| format!("{reason} ({count})"))
                .collect();
            let verdict = match outcome.refused_share() > REFUSED {
                true => {
                    "; the intervals are those of what the model covers, not of what was stated"
                }
                false => "",
            };
            warnings.push(format!(
                "{} of {} draws refused: {}{verdict}",
                outcome.of.draws - outcome.accepted,
                outcome.of.draws,
                reasons.join(", ")
            ));
        }
        warnings
    }
}
