//! Parametric bootstrap of the estimate with the set-up's errors: what was read off of the set-up and the noise are drawn, and all
//! of it is estimated anew.

use bolted_joint_draws::Draw;
use bolted_joint_systematic::{
    Cause, CauseEstimate, Estimate, Origin, Settings, Start, draw, estimate, estimate_near,
};
use rand_distr::{Distribution, StandardNormal};

use super::super::bootstrap::Bootstrap;
use super::super::lines::Lines;
use super::super::lines_estimate::LinesEstimate;
use super::super::study::Study;
use super::{MOST_LINES, MOST_LINES_OF_A_SEARCH, Systematic, experiment, together};

impl Systematic {
    /// The unknowns that are estimated from each draw, if the search comes to rest on it. A draw begins at
    /// the joint and the causes that it was made with and, where that leads to nothing that fits, as an identification
    /// does. Many lines are thinned out, and their noise is as much less. `progress` is called after each.
    pub(in super::super) fn draws(
        &self,
        study: &Study,
        all: &[Lines],
        plain: &LinesEstimate,
        bootstrap: &Bootstrap,
        progress: &(dyn Fn() + Sync),
    ) -> Vec<Draw> {
        let Ok(all) = together(study, all) else {
            return bootstrap.made(|_| None);
        };
        let few: Vec<Lines> = all
            .iter()
            .map(|lines| lines.at_most(MOST_LINES_OF_A_SEARCH))
            .collect();
        let count = |lines: &[Lines]| lines.first().map_or(0, |lines| lines.frequency_hz.len());
        let refined = count(&all).clamp(1, MOST_LINES);
        let part = count(&few) as f64 / refined as f64;
        let causes: Vec<CauseEstimate> = self.causes.iter().map(|(_, cause)| *cause).collect();
        let of_causes: Vec<(Cause, f64)> = causes
            .iter()
            .map(|cause| (cause.prior.cause, cause.value))
            .collect();
        let layout = study.layout();
        bootstrap.made(|mut generator| {
            let mut normal = || StandardNormal.sample(&mut generator);
            let joints = plain.joint_numbers();
            let mut drawn = experiment::of(study, &few, joints, &layout, self.levels)?;
            let origin = Origin {
                unknowns: &self.unknowns,
                causes: &causes,
                scale: part * self.reduced_chi_squared.unwrap_or(1.0).max(1.0),
            };
            let priors = draw(&mut drawn, &origin, &mut normal)?;
            let start = Start {
                causes: of_causes.clone(),
                unknowns: self.unknowns.clone(),
            };
            let settings = Settings::default();
            // what leaves more than noise would be refused, too
            let fits = |found: &Estimate| found.fits(&settings);
            let near = estimate_near(&drawn, &priors, &start, &settings).filter(fits);
            let found = near.or_else(|| {
                let start = Start::without_causes(&self.unknowns);
                estimate(&drawn, &priors, &start, &settings).filter(fits)
            });
            progress();
            Some(found?.unknowns)
        })
    }
}
