//! Tables 4.6 to 4.9 themselves.

use crate::draws::{Repetition, rows};
use crate::error::ReproduceError;
use crate::outcome::Row;
use bolted_joint_identify::{JointMatrices, JointModel};
use bolted_joint_respond::Pollution;

use super::{Approach, Case, END_TO_END, LAPPED, truth};

/// What approach 2 returns without noise, wherever the joint is; `published` by approach 2, where it is.
fn single_point_rows(end_to_end: &Case, published: &[f64]) -> Result<Vec<Row>, ReproduceError> {
    let lapped = Case::new(LAPPED)?;
    let mut found = joint_rows("no noise, 2s alone", published, &end_to_end.single_point());
    let of_lapped = lapped.single_point();
    found.extend(joint_rows(
        "no noise, 2s alone, lap of 60 mm",
        published,
        &of_lapped,
    ));
    Ok(found)
}

fn joint_rows(case: &str, published: &[f64], joints: &[JointMatrices]) -> Vec<Row> {
    rows(
        case,
        JointModel::Diagonal,
        Some(&truth()),
        published,
        joints,
    )
}

/// Approach 2 in Table 4.6.
pub(super) const APPROACH_2: [f64; 4] = [9.51e4, 9.04e2, 4.1, 0.055];
/// k_Fy, k_Mθ, c_Fy, c_Mθ at 1 % by response pollution (4.3.2): the same as approach 4 in Table 4.6.
const RESPONSE_1: [f64; 4] = [1.0003e5, 9.78e2, 4.998, 0.049];
/// The same by FRF pollution (4.3.1).
const FRF_1: [f64; 4] = [9.89e4, 9.93e2, 4.998, 0.067];

pub(crate) fn table_4_6(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let case = Case::new(END_TO_END)?;
    let mut found = Vec::new();
    for (name, approach, published) in [
        (
            "1: y and θ at 2s",
            Approach::One,
            [9.68e4, 8.77e2, 4.6, 0.047],
        ),
        ("2: y at 2s", Approach::Two, APPROACH_2),
        (
            "3: y at 2s, 3s",
            Approach::Three,
            [9.75e4, 9.20e2, 4.8, 0.046],
        ),
        (
            "4: y at 1s, 2s, 3s",
            Approach::Four,
            [1.00e5, 9.78e2, 5.0, 0.049],
        ),
    ] {
        for (samples, noise) in draws.responses(0.01) {
            let joints = case.joints(draws, approach, noise)?;
            found.extend(joint_rows(&format!("{name}{samples}"), &published, &joints));
        }
    }
    found.extend(single_point_rows(&case, &APPROACH_2)?);
    for &samples in draws.samples() {
        found.extend(case.noise_rows(0.01, samples));
    }
    Ok(found)
}

pub(crate) fn table_4_7(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let case = Case::new(END_TO_END)?;
    let mut found = Vec::new();
    for (name, level, published) in [
        ("10 %", 0.10, [9.80e4, 7.64e2, 5.29, 0.218]),
        ("5 %", 0.05, [9.79e4, 8.44e2, 4.86, 0.199]),
        ("3 %", 0.03, [9.79e4, 1.06e3, 5.12, 0.228]),
        ("1 %", 0.01, FRF_1),
    ] {
        let noise = Pollution::Frf { level };
        let joints = case.joints(draws, Approach::Four, noise)?;
        found.extend(joint_rows(name, &published, &joints));
    }
    found.extend(single_point_rows(&case, &[])?);
    Ok(found)
}

pub(crate) fn table_4_8(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let case = Case::new(END_TO_END)?;
    let mut found = Vec::new();
    for (name, level, published) in [
        ("10 %", 0.10, [9.76e4, 8.52e2, 4.71, -0.002]),
        ("5 %", 0.05, [9.79e4, 9.22e2, 4.56, 0.006]),
        ("3 %", 0.03, [9.89e4, 9.70e2, 4.995, 0.012]),
        ("1 %", 0.01, RESPONSE_1),
    ] {
        for (samples, noise) in draws.responses(level) {
            let joints = case.joints(draws, Approach::Four, noise)?;
            found.extend(joint_rows(&format!("{name}{samples}"), &published, &joints));
        }
    }
    found.extend(single_point_rows(&case, &[])?);
    Ok(found)
}

pub(crate) fn table_4_9(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let case = Case::new(END_TO_END)?;
    let mut found = Vec::new();
    let response = draws.responses(0.01).into_iter();
    let response = response.map(|(samples, noise)| {
        (
            format!("response pollution (4.3.2){samples}"),
            noise,
            RESPONSE_1,
        )
    });
    let frf = Pollution::Frf { level: 0.01 };
    for (name, noise, published) in
        response.chain([("FRF pollution (4.3.1)".to_owned(), frf, FRF_1)])
    {
        let joints = case.joints(draws, Approach::Four, noise)?;
        found.extend(joint_rows(&name, &published, &joints));
    }
    Ok(found)
}
