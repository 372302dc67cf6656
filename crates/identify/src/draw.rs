//! Data drawn from a fitted model, all noise included.

use std::sync::Arc;

use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, StandardNormal};

use super::group::Group;
use super::objective::{Objective, State, Weights};
use super::weights::source_variances;

/// Data as the model makes them at `state`, with errors of these variances.
pub(super) fn draw(
    objective: &Objective<'_>,
    weights: &[Weights],
    state: &State,
    generator: &mut ChaCha8Rng,
) -> Option<Vec<Group>> {
    let mut drawn = objective.groups.to_vec();
    let mut variances = Vec::new();
    objective.visit(state, &mut |number, line| {
        let group = &mut drawn[number];
        let weights = &weights[number];
        let size = line.computed.len();
        let mut at = 0;
        for block in &mut group.blocks {
            let count = block.entries.len();
            for e in 0..count {
                let variance = weights.entries[line.index * size + at + e];
                let place = line.index * count + e;
                if !variance.is_finite() {
                    continue;
                }
                block.measured[place] = line.computed[at + e] + circular(variance, generator);
                let measurements = block.entries[e].count;
                if measurements > 1 {
                    let draws = (1..measurements).map(|_| -> f64 { Exp1.sample(generator) });
                    let sum: f64 = draws.sum();
                    block.scatter[place] = sum * variance * f64::from(measurements);
                }
            }
            at += count;
        }
        let own = &objective.groups[number];
        source_variances(own, weights.levels, line.index, &mut variances);
        for (s, variance) in variances.iter().enumerate() {
            let place = line.index * variances.len() + s;
            let error = circular(*variance, generator);
            shift(
                group,
                s,
                line.index,
                state.corrections[number][place] + error,
            );
        }
    })?;
    Some(drawn)
}

/// Adds to a measured receptance of a substructure, and to all that was formed from it.
fn shift(group: &mut Group, s: usize, line: usize, by: Complex64) {
    let source = &mut group.sources[s];
    let place = source.place(line);
    Arc::make_mut(&mut source.value)[place] += by;
    for (block, pattern) in group.blocks.iter_mut().zip(&source.patterns) {
        let Some(pattern) = pattern else { continue };
        let add = |values: &mut [Complex64], size: usize, shares: &[f64]| {
            let values = values[line * size..(line + 1) * size].iter_mut();
            for (value, share) in values.zip(shares) {
                *value += by * share;
            }
        };
        add(&mut block.free, block.dofs * block.dofs, &pattern.free);
        add(
            &mut block.transfer,
            block.dofs * block.points,
            &pattern.transfer,
        );
        add(&mut block.own, block.entries.len(), &pattern.own);
    }
}

fn circular(variance: f64, generator: &mut ChaCha8Rng) -> Complex64 {
    let part = (0.5 * variance).sqrt();
    let (re, im): (f64, f64) = (
        StandardNormal.sample(generator),
        StandardNormal.sample(generator),
    );
    Complex64::new(part * re, part * im)
}
