//! Which variables belong to the rotation θ, and so are absent from the FMU of a joint that only translates.

/// Whether a variable of this name exists only where the joint has a rotational degree of freedom.
///
/// The rule: the last part of the structured name, cut at its underscores, contains `omega`, `alpha`, `M`, `J` or a word that
/// ends in `theta`. So `a.omega`, `b.M`, `a.J`, `a.c_theta`, `joint.k_ytheta` and `joint.k3_theta` need rotation;
/// `a.m`, `joint.k_yy` and `step_size_max` do not.
#[must_use]
pub fn requires_rotation(name: &str) -> bool {
    let last = name.rsplit('.').next().unwrap_or(name);
    last.split('_')
        .any(|word| matches!(word, "omega" | "alpha" | "M" | "J") || word.ends_with("theta"))
}

#[cfg(test)]
mod tests {
    use super::requires_rotation;

    #[test]
    fn rotational_names_are_told_from_translational_ones() {
        for name in [
            "a.theta",
            "b.omega",
            "a.alpha",
            "a.M",
            "joint.M",
            "b.J",
            "a.k_theta",
            "joint.k_ytheta",
            "joint.c_thetatheta",
            "joint.k3_theta",
        ] {
            assert!(requires_rotation(name), "{name}");
        }
        for name in [
            "time",
            "a.y",
            "b.v",
            "b.acceleration",
            "a.F",
            "joint.F",
            "a.m",
            "a.k_y",
            "joint.k_yy",
            "joint.c_yy",
            "joint.k3_y",
            "energy.stored",
            "power.dissipated",
            "step_size_max",
        ] {
            assert!(!requires_rotation(name), "{name}");
        }
    }
}
