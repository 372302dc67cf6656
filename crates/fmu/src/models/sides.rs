//! Where the two sides of the joint, and its law, are among the variables.

use bolted_joint_dynamics::{
    Body, JointLaw, JointMemory, Linear, Motion, Number, Polynomial, is_positive_semidefinite,
};

use crate::interface::{Dependence, Dofs, Kind, Values, Variable, Variables, reference as vr};

/// Value references of one side, translation first, then rotation.
pub(super) struct Side {
    pub(super) displacement: [usize; 2],
    velocity: [usize; 2],
    load: [usize; 2],
    acceleration: [usize; 2],
    pub(super) inertia: [usize; 2],
    stiffness: [usize; 2],
    damping: [usize; 2],
}

/// Side a.
pub(super) const A: Side = Side {
    displacement: [vr::A_Y, vr::A_THETA],
    velocity: [vr::A_V, vr::A_OMEGA],
    load: [vr::A_FORCE, vr::A_MOMENT],
    acceleration: [vr::A_ACCELERATION, vr::A_ALPHA],
    inertia: [vr::A_MASS, vr::A_MOMENT_OF_INERTIA],
    stiffness: [vr::A_K_Y, vr::A_K_THETA],
    damping: [vr::A_C_Y, vr::A_C_THETA],
};

/// Side b.
pub(super) const B: Side = Side {
    displacement: [vr::B_Y, vr::B_THETA],
    velocity: [vr::B_V, vr::B_OMEGA],
    load: [vr::B_FORCE, vr::B_MOMENT],
    acceleration: [vr::B_ACCELERATION, vr::B_ALPHA],
    inertia: [vr::B_MASS, vr::B_MOMENT_OF_INERTIA],
    stiffness: [vr::B_K_Y, vr::B_K_THETA],
    damping: [vr::B_C_Y, vr::B_C_THETA],
};

impl Side {
    /// Value references of displacements and of velocities.
    pub(super) fn motion_references<const D: usize>(&self) -> [[usize; D]; 2] {
        [&self.displacement, &self.velocity].map(|all| std::array::from_fn(|dof| all[dof]))
    }

    /// Value references of the loads.
    #[inline]
    pub(super) fn load_references<const D: usize>(&self) -> [usize; D] {
        std::array::from_fn(|dof| self.load[dof])
    }

    #[inline]
    pub(super) fn motion<const D: usize>(&self, values: &Values) -> Motion<D> {
        Motion {
            displacement: gather(values, &self.displacement),
            velocity: gather(values, &self.velocity),
        }
    }

    #[inline]
    pub(super) fn set_motion<const D: usize>(&self, values: &mut Values, motion: &Motion<D>) {
        scatter(values, &self.displacement, &motion.displacement);
        scatter(values, &self.velocity, &motion.velocity);
    }

    #[inline]
    pub(super) fn load<const D: usize>(&self, values: &Values) -> [f64; D] {
        gather(values, &self.load)
    }

    #[inline]
    pub(super) fn set_load<const D: usize>(&self, values: &mut Values, load: &[f64; D]) {
        scatter(values, &self.load, load);
    }

    pub(super) fn acceleration<const D: usize>(&self, values: &Values) -> [f64; D] {
        gather(values, &self.acceleration)
    }

    pub(super) fn set_acceleration<const D: usize>(
        &self,
        values: &mut Values,
        acceleration: &[f64; D],
    ) {
        scatter(values, &self.acceleration, acceleration);
    }

    pub(super) fn body<const D: usize>(&self, values: &Values) -> Body<D> {
        Body {
            inertia: gather(values, &self.inertia),
            stiffness: gather(values, &self.stiffness),
            damping: gather(values, &self.damping),
        }
    }
}

/// Law of the joint.
#[inline]
pub(super) fn joint_law<const D: usize>(values: &Values) -> JointLaw<D> {
    const STIFFNESS: [[usize; 2]; 2] = [
        [vr::JOINT_K_YY, vr::JOINT_K_YTHETA],
        [vr::JOINT_K_YTHETA, vr::JOINT_K_THETATHETA],
    ];
    const DAMPING: [[usize; 2]; 2] = [
        [vr::JOINT_C_YY, vr::JOINT_C_YTHETA],
        [vr::JOINT_C_YTHETA, vr::JOINT_C_THETATHETA],
    ];
    const CUBIC: [usize; 2] = [vr::JOINT_K3_Y, vr::JOINT_K3_THETA];
    const QUINTIC: [usize; 2] = [vr::JOINT_K5_Y, vr::JOINT_K5_THETA];
    const SEPTIC: [usize; 2] = [vr::JOINT_K7_Y, vr::JOINT_K7_THETA];
    const DAMPING_QUADRATIC: [usize; 2] = [vr::JOINT_C2_Y, vr::JOINT_C2_THETA];
    const DAMPING_QUARTIC: [usize; 2] = [vr::JOINT_C4_Y, vr::JOINT_C4_THETA];
    Linear {
        stiffness: std::array::from_fn(|row| gather(values, &STIFFNESS[row])),
        damping: std::array::from_fn(|row| gather(values, &DAMPING[row])),
    }
    .beside(Polynomial::on_each(
        &[CUBIC, QUINTIC, SEPTIC].map(|term| gather(values, &term)),
        &[DAMPING_QUADRATIC, DAMPING_QUARTIC].map(|term| gather(values, &term)),
    ))
}

/// Writes the calculated parameters `joint.escape_amplitude_y` and `joint.escape_amplitude_theta`.
pub(super) fn set_escape_amplitude<const D: usize>(values: &mut Values, amplitude: &[f64; D]) {
    const ESCAPE: [usize; 2] = [
        vr::JOINT_ESCAPE_AMPLITUDE_Y,
        vr::JOINT_ESCAPE_AMPLITUDE_THETA,
    ];
    scatter(values, &ESCAPE, amplitude);
}

/// Whether the joint's stiffness and damping can feed energy.
pub(super) fn is_active<const D: usize>(law: &JointLaw<D>) -> [bool; 2] {
    [&law.linear.stiffness, &law.linear.damping].map(|matrix| !is_positive_semidefinite(matrix))
}

/// What the joint puts out.
pub(super) struct JointOutputs<const D: usize, N> {
    /// Load on side b.
    pub(super) on_b: [N; D],
    /// Energy stored in the springs.
    pub(super) stored_energy: N,
    /// Power turned into heat.
    pub(super) dissipated_power: N,
}

impl<const D: usize, N: Number> JointOutputs<D, N> {
    /// Of a joint that remembers `memory`, at this relative motion.
    #[inline]
    pub(super) fn new(
        law: &JointLaw<D, N>,
        memory: &JointMemory<D>,
        relative: &Motion<D, N>,
    ) -> Self {
        Self {
            on_b: law.load_on_b_after(memory, relative),
            stored_energy: law.stored_energy_after(memory, &relative.displacement),
            dissipated_power: law.dissipated_power_after(memory, relative),
        }
    }
}

/// Writes what the joint puts out, or its change.
#[inline]
pub(super) fn set_joint_outputs<const D: usize, N: Copy>(
    values: &mut Values,
    outputs: &JointOutputs<D, N>,
    of: impl Fn(N) -> f64,
) {
    let references = [vr::JOINT_FORCE, vr::JOINT_MOMENT];
    scatter(values, &references, &outputs.on_b.map(&of));
    values[vr::ENERGY_STORED] = of(outputs.stored_energy);
    values[vr::POWER_DISSIPATED] = of(outputs.dissipated_power);
}

/// Name of a variable that both FMUs have.
pub(super) fn name(reference: usize) -> &'static str {
    variable(reference).map_or("", |variable| variable.name)
}

/// Unit of a variable that both FMUs have.
pub(super) fn unit(reference: usize) -> &'static str {
    variable(reference).map_or("", |variable| variable.unit)
}

/// The variable of the lap, which has all that the element has.
fn variable(reference: usize) -> Option<&'static Variable> {
    Variables {
        kind: Kind::Lap,
        dofs: Dofs::Two,
        dependence: Dependence::Constant,
    }
    .get(reference)
}

#[inline]
fn gather<const D: usize>(values: &Values, references: &[usize; 2]) -> [f64; D] {
    std::array::from_fn(|dof| values[references[dof]])
}

#[inline]
fn scatter<const D: usize>(values: &mut Values, references: &[usize; 2], from: &[f64; D]) {
    for dof in 0..D {
        values[references[dof]] = from[dof];
    }
}
