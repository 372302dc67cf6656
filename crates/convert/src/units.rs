//! In which units the numbers of a finite-element model are.

/// A consistent set of units; seconds and radians in all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Units {
    /// N, m, kg.
    #[default]
    Si,
    /// N, mm, t: stresses come in MPa.
    Millimetres,
}

impl Units {
    /// All of its units, in a comment.
    pub(crate) fn names(self) -> &'static str {
        match self {
            Self::Si => "N, m, rad, s, kg",
            Self::Millimetres => "N, mm, rad, s, t",
        }
    }

    /// Unit of a length.
    pub(crate) fn of_length(self) -> &'static str {
        match self {
            Self::Si => "m",
            Self::Millimetres => "mm",
        }
    }

    /// Units of length in a metre.
    fn in_metre(self) -> f64 {
        match self {
            Self::Si => 1.0,
            Self::Millimetres => 1e3,
        }
    }

    /// What an entry in N, m and rad is to be multiplied by: a load of motion i (x, y, z, rx, ry, rz) over a motion j.
    pub(crate) fn factor(self, i: usize, j: usize) -> f64 {
        let is_rotation = |motion: usize| motion >= 3;
        let of_moment = if is_rotation(i) { self.in_metre() } else { 1.0 };
        let of_displacement = if is_rotation(j) { 1.0 } else { self.in_metre() };
        of_moment / of_displacement
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_newton_per_metre_is_a_thousandth_per_millimetre() {
        let mm = Units::Millimetres;
        assert_eq!([mm.factor(0, 2), mm.factor(3, 5)], [1e-3, 1e3]);
        // N/rad and N·mm/mm
        assert_eq!([mm.factor(1, 5), mm.factor(5, 1)], [1.0, 1.0]);
        assert_eq!(Units::Si.factor(3, 3), 1.0);
    }
}
