//! Where the two sides of the joint, and its law, are among the variables.

use bolted_joint_dynamics::{
    Body, DOF_COUNT, DOFS, DofLaws, JointLaw, Linear, Motion, Polynomial, is_positive_semidefinite,
    law::{FORGETFUL_PARAMETER_COUNT, Law, TERM_COUNT, dof_parameters},
};

use crate::{
    interface::{Values, declared, first_row, gather, reference as vr, scatter},
    refusal::Refusal,
};

/// Value references of one side, by DOFs.
pub(super) struct Side {
    pub(super) displacement: [usize; DOF_COUNT],
    velocity: [usize; DOF_COUNT],
    load: [usize; DOF_COUNT],
    acceleration: [usize; DOF_COUNT],
    pub(super) inertia: [usize; DOF_COUNT],
    stiffness: [usize; DOF_COUNT],
    damping: [usize; DOF_COUNT],
}

/// Side a.
pub(super) const A: Side = Side {
    displacement: vr::A_DISPLACEMENT,
    velocity: vr::A_RATE,
    load: vr::A_LOAD,
    acceleration: vr::A_ACCELERATION,
    inertia: vr::A_INERTIA,
    stiffness: vr::A_K,
    damping: vr::A_C,
};

/// Side b.
pub(super) const B: Side = Side {
    displacement: vr::B_DISPLACEMENT,
    velocity: vr::B_RATE,
    load: vr::B_LOAD,
    acceleration: vr::B_ACCELERATION,
    inertia: vr::B_INERTIA,
    stiffness: vr::B_K,
    damping: vr::B_C,
};

impl Side {
    /// Value references of displacements and of velocities.
    pub(super) fn motion_references<const D: usize>(&self) -> [[usize; D]; 2] {
        [&self.displacement, &self.velocity]
            .map(|all| std::array::from_fn(|dof| all[first_row::<D>() + dof]))
    }

    /// Value references of the loads.
    #[inline]
    pub(super) fn load_references<const D: usize>(&self) -> [usize; D] {
        std::array::from_fn(|dof| self.load[first_row::<D>() + dof])
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
    JointLaw {
        linear: joint_linear(values),
        on: std::array::from_fn(|dof| {
            let references = &vr::LAW_PARAMETERS[first_row::<D>() + dof];
            if values.has_further() {
                return DofLaws::new(references.map(|reference| values[reference]));
            }
            DofLaws::of_each_kind(&std::array::from_fn(|place| values[references[place]]))
        }),
    }
}

/// Its linear part.
#[inline]
pub(super) fn joint_linear<const D: usize>(values: &Values) -> Linear<D> {
    Linear {
        stiffness: std::array::from_fn(|row| gather(values, &vr::JOINT_K[first_row::<D>() + row])),
        damping: std::array::from_fn(|row| gather(values, &vr::JOINT_C[first_row::<D>() + row])),
    }
}

/// What remembers nothing beside that: the polynomial, whose parameters are the first of all laws'.
#[inline]
pub(super) fn joint_polynomials<const D: usize>(values: &Values) -> [Polynomial; D] {
    const { assert!(FORGETFUL_PARAMETER_COUNT == TERM_COUNT) };
    std::array::from_fn(|dof| {
        let parameters: [f64; FORGETFUL_PARAMETER_COUNT] =
            std::array::from_fn(|place| values[vr::LAW_PARAMETERS[first_row::<D>() + dof][place]]);
        Polynomial::new(&parameters)
    })
}

/// Whether each law's parameters are in its range.
pub(super) fn check_laws<const D: usize>(law: &JointLaw<D>) -> Result<(), Refusal> {
    let Some((dof, declaration, outside)) = law.outside() else {
        return Ok(());
    };
    let symbol = declaration
        .parameters
        .get(outside.parameter)
        .map_or("", |parameter| parameter.symbol);
    let mut all = law.on[dof].parameters().iter().zip(dof_parameters());
    let found = all.find(|(_, (law, parameter))| {
        law.number == declaration.number && parameter.symbol == symbol
    });
    Err(Refusal::OutsideLaw {
        name: declaration.variable(symbol, DOFS[first_row::<D>() + dof].name),
        found: found.map_or(f64::NAN, |(&value, _)| value),
        expected: outside.expected,
    })
}

/// Whether the joint's stiffness and damping can feed energy.
pub(super) fn is_active<const D: usize>(law: &JointLaw<D>) -> [bool; 2] {
    [&law.linear.stiffness, &law.linear.damping].map(|matrix| !is_positive_semidefinite(matrix))
}

/// Name of a variable that both FMUs have.
pub(super) fn name(reference: usize) -> &'static str {
    declared(reference).map_or("", |variable| &*variable.name)
}

/// Unit of a variable that both FMUs have.
pub(super) fn unit(reference: usize) -> &'static str {
    declared(reference).map_or("", |variable| &*variable.unit)
}
