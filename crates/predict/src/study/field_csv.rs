//! The interface element by element, for finite-element programs that take springs node by node.

use std::fmt::Write as _;

use super::prediction::Prediction;

impl Prediction<'_> {
    /// A table (CSV): place, area and pressure of each element, and its stiffness and hysteretic damping, at the nominal torque.
    #[must_use]
    pub fn field_csv(&self) -> String {
        let state = self.nominal();
        let name = self.study.name.replace(['\n', '\r'], " ");
        let at = state
            .torque_n_m
            .map(|torque| format!(", at {torque} N·m"))
            .unwrap_or_default();
        let mut text = format!(
            "# {name}{at}\n# z normal to the interface; k stiffness, d hysteretic damping of each element\n\
             x_m,y_m,area_m2,pressure_Pa,k_n_N_per_m,k_t_N_per_m,d_n_N_per_m,d_t_N_per_m\n"
        );
        for (element, contact) in state.field.elements().iter().zip(&state.contacts) {
            let of_area = |density: f64| density * element.area_m2;
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "{:e},{:e},{:e},{:e},{:e},{:e},{:e},{:e}",
                element.x_m,
                element.y_m,
                element.area_m2,
                element.pressure_pa,
                of_area(contact.normal_stiffness_n_per_m3),
                of_area(contact.tangential_stiffness_n_per_m3),
                of_area(contact.normal_damping_n_per_m3),
                of_area(contact.tangential_damping_n_per_m3),
            );
        }
        text
    }
}
