//! What is left of a step that is too short to be taken as one: importers that subtract times leave such remainders.

use super::super::{coordinates::Parts, products::dot, state::Underway};
use super::Scratch;

impl Scratch {
    /// z + δ ż under the present loads. Friction that moves on the way counts its heat in the step that follows.
    pub(in super::super) fn creep(&mut self, parts: &Parts, state: &mut Underway, rest_s: f64) {
        let (system, sight) = (&parts.system, &parts.sight);
        let (m, d) = (system.loads, system.forces());
        self.follow(system);
        let laws = self.laws.first().unwrap_or(&system.laws);
        let [now, ..] = &mut self.relative;
        sight.relative(&state.motion, now);
        let acting = &mut self.powers[..m + d];
        acting[..m].copy_from_slice(&self.loads[0][..m]);
        laws.forces(system, &state.memory, now, &mut acting[m..]);
        let (r, velocity) = now.split_at(d);
        let supplied: f64 = (0..m)
            .map(|load| acting[load] * dot(sight.velocities.row(load), &state.motion))
            .sum();
        let into_laws = dot(&acting[m..], velocity);
        let heat = laws.viscous_power(system, r, velocity);
        state.supplied_j += rest_s * supplied;
        state.balance_j += rest_s * (supplied - into_laws + heat);
        let rates = &mut self.state.motion;
        parts.rates(&state.motion, rates);
        parts.acting.add_rows_to(acting, rates);
        for (own, rate) in state.motion.iter_mut().zip(rates) {
            *own += rest_s * *rate;
        }
    }
}
