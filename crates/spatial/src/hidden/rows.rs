//! What sensors and impacts see of the motions and loads of their interface, where these are known to a budget only.

use bolted_joint_virtual_point::Role;
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::error::SpatialError;
use crate::patterns::Pattern;
use crate::side::{Reduction, Side};

/// R_u, R_f of one side with errors of its set-up, and how they change with each of these.
pub(super) struct Rows {
    /// R_u, responses × (motions + others); R_f, references × (motions + others); and their inverses.
    pub(super) reduction: Reduction,
    /// R_u of the assembly, whose sensors may be elsewhere.
    pub(super) seen: DMatrix<Complex64>,
    /// R_f of the assembly, whose hits may be others.
    pub(super) struck: DMatrix<Complex64>,
    /// dR_u by each error of the sensors, channels × motions; dR_f by each of the impacts, impacts × motions.
    pub(super) changes: [Vec<DMatrix<f64>>; 2],
    /// Likewise dR_u of the assembly by each error of its sensors against these.
    pub(super) of_sensors: Vec<DMatrix<f64>>,
    /// And dR_f by each of its hits.
    pub(super) of_hits: Vec<DMatrix<f64>>,
}

impl Rows {
    pub(super) fn of(side: &Side, errors: &[f64]) -> Result<Self, SpatialError> {
        let displaced = side.displaced(errors)?;
        let reduction = displaced.reduction()?;
        let mut changes = [Vec::new(), Vec::new()];
        let [mut of_sensors, mut of_hits] = [Vec::new(), Vec::new()];
        let mut seen = reduction.rows.clone();
        let mut struck = reduction.columns.clone();
        if let Some((placed, set_up)) = displaced.points() {
            let motions = reduction.own.rows();
            for (rows, own) in [(&mut seen, &placed.seen), (&mut struck, &placed.struck)] {
                if let Some(own) = own {
                    let own = own.select_columns(&motions).map(Complex64::from);
                    let mut near = rows.view_mut((0, 0), own.shape());
                    near += own;
                }
            }
            if let Some((placed, _)) = side.points() {
                for (all, role, anew) in [
                    (&mut of_sensors, Role::Channel, side.anew.sensors),
                    (&mut of_hits, Role::Impact, side.anew.hits),
                ] {
                    let poses = anew.map_or_else(Vec::new, |_| placed.poses(role));
                    let changes = poses.into_iter();
                    all.extend(changes.map(|(_, change)| change.select_columns(&motions)));
                }
            }
            let mut rest = errors;
            for (own, role) in changes.iter_mut().zip([Role::Channel, Role::Impact]) {
                let places = set_up.places(role);
                *own = places.derivatives();
                let (first, others) = rest.split_at(own.len());
                rest = others;
                let by_vectors = places.by_rotation_vectors(own, first);
                by_vectors.map_err(|source| placed.refused(source))?;
                for change in own {
                    *change = change.select_columns(&motions);
                }
            }
        }
        Ok(Self {
            reduction,
            seen,
            struck,
            changes,
            of_sensors,
            of_hits,
        })
    }

    /// Channels, and impacts, of the interface.
    pub(super) fn near(&self) -> [usize; 2] {
        let motions = self.reduction.own.count();
        let near = |own: &DMatrix<Complex64>| own.nrows() - (own.ncols() - motions);
        [&self.reduction.rows, &self.reduction.columns].map(near)
    }

    /// What each error does, by the dyads of the channels (first those, channel by channel, all motions each), of the impacts (motion
    /// by motion, all impacts each) and likewise of the assembly's sensors and hits; `first` is the place of the first dyad.
    pub(super) fn patterns(&self, first: usize) -> Vec<Pattern> {
        let [channels, impacts] = self.near();
        let motions = self.reduction.own.count();
        let of_motions = move |first: usize, change: &DMatrix<f64>| {
            let places = (0..channels).flat_map(|p| (0..motions).map(move |q| (p, q)));
            Pattern::new(places.map(|(p, q)| (first + motions * p + q, change[(p, q)])))
        };
        let of_channels = self.changes[0].iter().map(|own| of_motions(first, own));
        let first = first + motions * channels;
        let of_forces = move |first: usize, change: &DMatrix<f64>| {
            let places = (0..motions).flat_map(|p| (0..impacts).map(move |q| (p, q)));
            Pattern::new(places.map(|(p, q)| (first + impacts * p + q, change[(q, p)])))
        };
        let of_impacts = self.changes[1].iter().map(|own| of_forces(first, own));
        let first = first + motions * impacts;
        let of_sensors = self.of_sensors.iter().map(|own| of_motions(first, own));
        let first = first + self.again()[0];
        let of_hits = self.of_hits.iter().map(|own| of_forces(first, own));
        let of_all = of_channels.chain(of_impacts);
        of_all.chain(of_sensors).chain(of_hits).collect()
    }

    /// Dyads that these are made of.
    pub(super) fn dyads(&self) -> usize {
        let [channels, impacts] = self.near();
        let [of_sensors, of_hits] = self.again();
        self.reduction.own.count() * (channels + impacts) + of_sensors + of_hits
    }

    /// Dyads of the assembly's sensors and of its hits, where they may be elsewhere.
    fn again(&self) -> [usize; 2] {
        let [channels, impacts] = self.near();
        let of = |own: &[DMatrix<f64>], count: usize| match own.is_empty() {
            true => 0,
            false => self.reduction.own.count() * count,
        };
        [of(&self.of_sensors, channels), of(&self.of_hits, impacts)]
    }
}
