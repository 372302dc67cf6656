//! The whole against check values of a NumPy program, and against exact cases.

use bolted_joint_testing::close;
use num_complex::Complex64;

use crate::Role;
use crate::samples::*;

/// Numbers of a NumPy program with the same definitions: three triaxial sensors, seven impacts, a row 10 % too large.
#[test]
fn check_values() {
    let point = equal(check_set_up());
    let (t_u, t_f) = (point.motions_of_channels(), point.forces_of_loads());
    for (found, expected) in [
        (t_u[(3, 0)], -0.196_958_171_71),
        (t_u[(5, 7)], 0.245_870_198_78),
        (t_f[(6, 3)], -17.020_749_582),
        (t_f[(0, 4)], -15.128_885_735),
        (point.conditioning(Role::Channel).condition, 3.735_338_847_4),
        (point.conditioning(Role::Impact).condition, 3.297_934_428_2),
        (
            point.conditioning(Role::Channel).length_m,
            3.628_590_176_2e-2,
        ),
        (
            point.conditioning(Role::Impact).length_m,
            3.545_621_041_7e-2,
        ),
    ] {
        close(found, expected, 1e-10);
    }
    let found = point.receptance(&check_functions()).unwrap();
    let expected = Complex64::new(4.481_219_947_6e-6, -1.338_027_602_4e-6);
    same(found[(0, 0)], expected, 1e-10);
    let expected = Complex64::new(-3.356_566_467_8e-8, -2.165_466_367_8e-9);
    same(found[(3, 5)], expected, 1e-10);
}
