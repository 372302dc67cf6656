//! Data drawn from a fitted model, all noise included.

use std::sync::Arc;

use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, StandardNormal};

use super::group::Group;
use super::objective::{Objective, State, Weights};

/// Data as the model makes them at `state`, with errors of these variances.
pub(super) fn draw<const N: usize>(
    objective: &Objective<'_, N>,
    weights: &[Weights],
    state: &State,
    generator: &mut ChaCha8Rng,
) -> Option<Vec<Group<N>>> {
    let mut drawn = objective.groups.to_vec();
    objective.visit(None, state, &mut |number, line| {
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
        let sources = group.sources.len();
        for s in 0..sources {
            let place = line.index * sources + s;
            let error = circular(weights.sources[place], generator);
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
fn shift<const N: usize>(group: &mut Group<N>, s: usize, line: usize, by: Complex64) {
    let source = &mut group.sources[s];
    Arc::make_mut(&mut source.value)[line] += by;
    for (block, pattern) in group.blocks.iter_mut().zip(&source.patterns) {
        let Some(pattern) = pattern else { continue };
        for i in 0..N {
            for j in 0..N {
                block.free[line][i][j] += by * pattern.free[i][j];
            }
        }
        let columns = &mut block.transfer[line * block.points..(line + 1) * block.points];
        for (column, shares) in columns.iter_mut().zip(&pattern.transfer) {
            for (value, share) in column.iter_mut().zip(shares) {
                *value += by * share;
            }
        }
        let count = block.entries.len();
        let own = &mut block.own[line * count..(line + 1) * count];
        for (value, share) in own.iter_mut().zip(&pattern.own) {
            *value += by * share;
        }
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
