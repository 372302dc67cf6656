//! Pressure fields: published forces, equilibrium, torques against their textbook formulas, fields from files, bad input refused.

use bolted_joint_testing::{begins, has};
use std::f64::consts::{PI, TAU};
use std::fs;

use bolted_joint::predict::pressure::{
    Balance, Bolt, BoltedInterface, Cone, ConePressure, PressureError, PressureField, Reach,
    Rectangle, ThicknessRatio, ThreadFriction, Tightening, Zone, ZoneForce, bolts_in_rows,
    bolts_on_circle, bolts_under_moment, coarse_pitch_m, with_preloads,
};
use proptest::prelude::*;
use tempfile::TempDir;

const CONE: Cone = Cone {
    half_angle_rad: PI / 6.0,
    head_diameter_m: 0.024,
    depth_m: 0.02,
    distribution: ConePressure::Parabolic,
};

fn polynomial(thickness_ratio: ThicknessRatio, reach: Reach, force: ZoneForce) -> Zone {
    Zone::Polynomial {
        thickness_ratio,
        reach,
        force,
    }
}

fn one_rivet() -> [Bolt; 1] {
    [Bolt {
        x_m: 0.0,
        y_m: 0.0,
        diameter_m: 0.008,
        preload_n: 5000.0,
    }]
}

#[test]
fn one_rivet_carries_what_the_thesis_says_or_its_preload() {
    let bolts = one_rivet();
    for (ratio, rim, published) in [
        (ThicknessRatio::One, 4.125, 0.8952),
        (ThicknessRatio::OneAndAHalf, 5.0, 1.1338),
        (ThicknessRatio::Two, 5.6, 1.2787),
    ] {
        let interface = |force, cells| BoltedInterface {
            outline: Rectangle::centred(0.06, 0.05).unwrap(),
            cells,
            bolts: &bolts,
            clearance_m: 0.0,
            zone: polynomial(ratio, Reach::Rivets, force),
        };
        for cells in [[7, 6], [61, 53]] {
            let as_published = interface(ZoneForce::AsPublished, cells).field().unwrap();
            let force_n = as_published.field.force_n();
            assert!((force_n / 5000.0 - published).abs() < 5e-5, "{force_n}");
            let imbalance = as_published.balance.force_imbalance();
            assert!((imbalance - (published - 1.0)).abs() < 5e-5);
            let carried = interface(ZoneForce::Preload, cells).field().unwrap();
            assert!(carried.balance.force_imbalance().abs() < 1e-12);
            assert_eq!(carried.cut_zones().count(), 0);
        }
        // The pressure at a point is the polynomial's, σ_s = P/(2.0625 π R_v²), but for the tail that would pull.
        let fine = interface(ZoneForce::AsPublished, [600, 500]);
        let fine = fine.field().unwrap();
        let stress_pa = 5000.0 / (2.0625 * PI * 0.004_f64.powi(2));
        let tail = match ratio {
            ThicknessRatio::One => 0.895_201_2 / 0.904_653_0,
            ThicknessRatio::OneAndAHalf => 1.133_830_2 / 1.133_848_9,
            ThicknessRatio::Two => 1.0,
        };
        for element in fine.field.elements() {
            let rho = element.x_m.hypot(element.y_m) / 0.004;
            if (1.05..rim - 0.35).contains(&rho) {
                let expected = tail * stress_pa * ratio.pressure_over_surface_stress(rho);
                assert!((element.pressure_pa / expected - 1.0).abs() < 1e-3, "{rho}");
            }
            if rho > rim + 0.03 {
                assert_eq!(element.pressure_pa, 0.0);
            }
        }
        let hole_m2 = PI * 0.004_f64.powi(2);
        assert!((fine.field.area_m2() / (0.06 * 0.05 - hole_m2) - 1.0).abs() < 1e-7);
    }
}

#[test]
fn the_zone_of_a_bolt_is_three_and_a_half_diameters_across() {
    let bolts = one_rivet();
    let zone = polynomial(ThicknessRatio::Two, Reach::Bolts, ZoneForce::Preload);
    assert!((zone.radius_m(&bolts[0]) - 0.014).abs() < 1e-15);
    let field = BoltedInterface {
        outline: Rectangle::centred(0.04, 0.04).unwrap(),
        cells: [200, 200],
        bolts: &bolts,
        clearance_m: 0.0,
        zone,
    }
    .field()
    .unwrap();
    let elements = field.field.elements().iter();
    let touching = elements.filter(|e| e.pressure_pa > 0.0);
    let farthest = touching.map(|e| e.x_m.hypot(e.y_m)).fold(0.0, f64::max);
    assert!((farthest / 0.014 - 1.0).abs() < 0.015, "{farthest}");
    assert!(field.balance.force_imbalance().abs() < 1e-12);
}

#[test]
fn a_cone_spreads_the_force_over_its_base() {
    let bolts = one_rivet();
    // R = d_w/2 + t tan 30°
    let rim_m = 0.012 + 0.02 / 3_f64.sqrt();
    let hole_m: f64 = 0.0045;
    for distribution in [ConePressure::Uniform, ConePressure::Parabolic] {
        let field = BoltedInterface {
            outline: Rectangle::centred(0.06, 0.06).unwrap(),
            cells: [121, 121],
            bolts: &bolts,
            clearance_m: 0.001,
            zone: Zone::Cone(Cone {
                distribution,
                ..CONE
            }),
        }
        .field()
        .unwrap();
        let ring_m2 = rim_m.powi(2) - hole_m.powi(2);
        let pressure = |r: f64| match distribution {
            ConePressure::Uniform => 5000.0 / (PI * ring_m2),
            // 2π ∫ p₀ (1 − r²/R²) r dr = p₀ π (R² − r_h²)²/(2R²)
            ConePressure::Parabolic => {
                (1.0 - (r / rim_m).powi(2)) * 5000.0 * 2.0 * rim_m.powi(2) / (PI * ring_m2.powi(2))
            }
        };
        for element in field.field.elements() {
            let r = element.x_m.hypot(element.y_m);
            if (hole_m + 0.001..rim_m - 0.001).contains(&r) {
                let error = element.pressure_pa / pressure(r) - 1.0;
                assert!(error.abs() < 2e-3, "{r}: {error}");
            }
        }
        assert!(field.balance.force_imbalance().abs() < 1e-12);
    }
}

#[test]
fn a_cut_zone_is_named_and_still_carries_its_preload() {
    let bolts = [Bolt {
        x_m: -0.012,
        y_m: 0.0,
        diameter_m: 0.008,
        preload_n: 5000.0,
    }];
    let interface = |zone| BoltedInterface {
        outline: Rectangle::new([-0.022, 0.03], [-0.03, 0.03]).unwrap(),
        cells: [52, 60],
        bolts: &bolts,
        clearance_m: 0.0,
        zone,
    };
    let uniform = Cone {
        half_angle_rad: 0.0,
        head_diameter_m: 0.04,
        depth_m: 0.0,
        distribution: ConePressure::Uniform,
    };
    let field = interface(Zone::Cone(uniform)).field().unwrap();
    // The edge lies half a radius from the axis: a segment of 120°.
    let radius: f64 = 0.02;
    let segment = radius.powi(2) * (PI / 3.0 - 3_f64.sqrt() / 4.0);
    let zone = PI * (radius.powi(2) - 0.004_f64.powi(2));
    let cut: Vec<_> = field.cut_zones().collect();
    assert_eq!(cut.len(), 1);
    assert!((cut[0].part_on_plate - (1.0 - segment / zone)).abs() < 1e-10);
    assert!((field.field.force_n() / 5000.0 - 1.0).abs() < 1e-12);
    let text = cut[0].to_string();
    begins(&text, "bolt 1: ");
    has(&text, &["cuts off 20.4 %"]);
    // The resultant moves inwards, and the balance says how far; the field can be brought into balance.
    let balance = field.balance;
    assert!(balance.offset_m()[0] > 1e-3 && balance.offset_m()[1].abs() < 1e-12);
    let target = balance.preload_moments_n_m;
    let balanced = field.field.carrying(5000.0, target).unwrap();
    let balance = Balance::of(&balanced.field, &bolts);
    assert!(balance.offset_m().iter().all(|offset| offset.abs() < 1e-12));
    let line = balance.to_string();
    has(&line, &["imbalance +0.00 %", "0.000 mm"]);
}

#[test]
fn the_bending_moment_of_zhao_is_bolts_tightened_unequally() {
    // Rows of three L_a = 0.3 m apart, two bolts between: M = (L_a/2)(F' − F'') N_b = 0.15 · 10 kN · 3 = 4500 N·m.
    let mut bolts = bolts_in_rows([2, 3], [0.3, 0.09], 0.016, 15e3).unwrap();
    bolts.extend(bolts_in_rows([1, 2], [0.0, 0.18], 0.016, 15e3).unwrap());
    let bent = bolts_under_moment(&bolts, [0.0, -4500.0]).unwrap();
    for bolt in &bent {
        let expected = 15e3 + 5e3 * bolt.x_m / 0.15;
        assert!((bolt.preload_n - expected).abs() < 1e-8);
    }
    let slack = bolts_under_moment(&bolts, [0.0, 15e3]).unwrap_err();
    let is_second = matches!(slack, PressureError::BoltSlack { number: 2, .. });
    assert!(is_second, "{slack}");
    let row = bolts_in_rows([4, 1], [0.05, 0.0], 0.01, 9e3).unwrap();
    assert!(bolts_under_moment(&row, [0.0, 100.0]).is_ok());
    let error = bolts_under_moment(&row, [100.0, 0.0]).unwrap_err();
    assert!(matches!(error, PressureError::CannotBend { .. }));
}

#[test]
fn preloads_from_torques() {
    let nut = Tightening::NutFactor {
        factor: 0.2,
        diameter_m: 0.01,
    };
    assert!((nut.preload_n(50.0).unwrap() - 25e3).abs() < 1e-9);
    // M10, head 16 mm over a hole of 11 mm. VDI 2230 to first order: T = F (P/2π + 0.577 d₂ μ_G + D_Km μ_K/2).
    let pitch_m = coarse_pitch_m(0.01).unwrap();
    assert_eq!(pitch_m, 1e-3 * 1.5);
    let thread = |thread_coefficient, head_coefficient| ThreadFriction {
        diameter_m: 0.01,
        pitch_m,
        thread_coefficient,
        head_coefficient,
        bearing_outer_diameter_m: 0.016,
        bearing_inner_diameter_m: 0.011,
    };
    let torque = |g, k| Tightening::Friction(thread(g, k)).torque_n_m(20e3).unwrap();
    assert!((thread(0.0, 0.0).pitch_diameter_m() - 9.026e-3).abs() < 5e-7);
    for (g, k) in [(0.08, 0.08), (0.12, 0.12), (0.14, 0.1)] {
        let first_order = 20e3 * (pitch_m / TAU + 0.577 * 9.026e-3 * g + 0.5 * 0.0135 * k);
        assert!((torque(g, k) / first_order - 1.0).abs() < 0.01);
    }
    // Without friction the work of a turn lifts the load by a pitch.
    assert!((torque(0.0, 0.0) - 20e3 * pitch_m / TAU).abs() < 1e-9);
    // The derivative of the flank's balance with respect to μ_G: d₂/(2 cos α_n cos² φ).
    let lead = (pitch_m / (PI * thread(0.0, 0.0).pitch_diameter_m())).atan();
    let normal = ((PI / 6.0).tan() * lead.cos()).atan();
    let slope = (torque(1e-6, 0.0) - torque(0.0, 0.0)) / 1e-6 / 20e3;
    let expected = 0.5 * thread(0.0, 0.0).pitch_diameter_m() / normal.cos() / lead.cos().powi(2);
    assert!((slope / expected - 1.0).abs() < 1e-5, "{slope} {expected}");
    let back = Tightening::Friction(thread(0.12, 0.1));
    let preload_n = back.preload_n(45.0).unwrap();
    assert!((back.torque_n_m(preload_n).unwrap() - 45.0).abs() < 1e-12);
    let error = back.preload_n(-1.0).unwrap_err().to_string();
    assert!(error.contains("torque") && error.contains("-1"), "{error}");
    let negative = Tightening::Friction(thread(-0.1, 0.1));
    assert!(negative.preload_n(1.0).is_err());
    assert!(coarse_pitch_m(0.0101).is_none());
    assert_eq!(coarse_pitch_m(1.6e-3), Some(1e-3 * 0.35));
    assert_eq!(coarse_pitch_m(64e-3), Some(1e-3 * 6.0));
}

fn in_file(text: &str, nominal_m2: Option<f64>) -> Result<PressureField, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("field.csv");
    fs::write(&path, text).unwrap();
    PressureField::read(&path, nominal_m2).map_err(|error| {
        let text = error.to_string();
        assert!(text.contains("field.csv"), "{text}");
        text
    })
}

#[test]
fn fields_from_files() {
    let text = "# nodes\nnode,x_mm,y_mm,area_mm2,pressure_MPa\n7,10,-5,2,1.5\n9,12,-5,2,0\n";
    let field = in_file(text, Some(4e-6)).unwrap();
    assert_eq!(field.elements().len(), 2);
    assert!((field.force_n() - 3.0).abs() < 1e-12);
    assert!((field.moments_n_m()[1] + 0.03).abs() < 1e-15);
    // Semicolons, decimal commas and other units.
    let other =
        "x [m];y [m];area [m²];pressure [Pa]\n0,01;-0,005;2e-6;1,5e6\n0,012;-0,005;2e-6;0\n";
    let same = in_file(other, None).unwrap();
    for (a, b) in field.elements().iter().zip(same.elements()) {
        assert!((a.x_m - b.x_m).abs() < 1e-15 && (a.pressure_pa - b.pressure_pa).abs() < 1e-6);
    }
    let again = in_file(&field.to_csv("as written"), None).unwrap();
    assert!((again.force_n() / field.force_n() - 1.0).abs() < 1e-14);
}

#[test]
fn bad_files_are_refused_with_their_line() {
    let header = "x_mm,y_mm,area_mm2,pressure_MPa\n";
    let refused = |rows: &str, nominal| in_file(&format!("{header}{rows}"), nominal).unwrap_err();
    let negative = refused("0,0,1,2\n1,0,1,-0.5\n", None);
    has(&negative, &["line 3", "-500000 Pa"]);
    let area = refused("0,0,0,2\n", None);
    assert!(area.contains("line 2") && area.contains("area"), "{area}");
    let word = refused("0,0,1,much\n", None);
    has(&word, &["line 2", "\"much\" as pressure_MPa"]);
    let short = refused("0,0,1\n", None);
    has(&short, &["line 2", "3 fields"]);
    let sum = refused("0,0,1,2\n1,0,1,2\n", Some(2e-4));
    has(&sum, &["0.000002 m²", "0.0002 m²"]);
    let none = in_file(header, None).unwrap_err();
    assert!(none.contains("no elements"), "{none}");
    let unit = in_file("x_mm,y_mm,area_mm2,pressure\n0,0,1,1\n", None).unwrap_err();
    has(&unit, &["line 1", "pressure_MPa"]);
    let twice = in_file("x_mm,x_m,y_mm,area_mm2,pressure_MPa\n", None).unwrap_err();
    assert!(twice.contains("second column"), "{twice}");
    assert!(matches!(
        PressureField::read("no/such/file.csv", None),
        Err(PressureError::Table(_))
    ));
}

#[test]
fn impossible_interfaces_are_refused() {
    let outline = Rectangle::centred(0.1, 0.1).unwrap();
    let zone = Zone::Cone(CONE);
    let field = |bolts: &[Bolt], cells, zone, clearance_m| {
        BoltedInterface {
            outline,
            cells,
            bolts,
            clearance_m,
            zone,
        }
        .field()
        .unwrap_err()
        .to_string()
    };
    let bolt = one_rivet()[0];
    let at = |x_m| Bolt { x_m, ..bolt };
    assert!(field(&[], [4, 4], zone, 0.0).contains("no bolts"));
    assert!(field(&[bolt], [0, 4], zone, 0.0).contains("0 × 4 cells"));
    assert!(field(&[bolt, at(0.048)], [4, 4], zone, 0.0).starts_with("bolt 2: its hole"));
    assert!(field(&[bolt, at(0.007)], [4, 4], zone, 0.0).contains("bolts 1 and 2"));
    assert!(field(&[bolt], [4, 4], zone, -1.0).contains("clearance"));
    let narrow = Zone::Cone(Cone {
        head_diameter_m: 0.007,
        depth_m: 0.0,
        ..CONE
    });
    assert!(field(&[bolt], [4, 4], narrow, 0.0).contains("expected the zone to be wider"));
    let flat = Zone::Cone(Cone {
        half_angle_rad: 2.0,
        ..CONE
    });
    assert!(field(&[bolt], [4, 4], flat, 0.0).contains("half angle is 2"));
    let pulled = Bolt {
        preload_n: -1.0,
        ..bolt
    };
    assert!(field(&[pulled], [4, 4], zone, 0.0).contains("preload is -1"));
    assert!(Rectangle::new([1.0, 0.0], [0.0, 1.0]).is_err());
    assert!(with_preloads(&[bolt], &[1.0, 2.0]).is_err());
    assert!(ThicknessRatio::of(2.4e-3, 3.6e-3).unwrap() == ThicknessRatio::OneAndAHalf);
    assert!(
        ThicknessRatio::of(2e-3, 5e-3)
            .unwrap_err()
            .to_string()
            .contains("0.005 m")
    );
    let even = PressureField::uniform(&outline, [10, 10], 100.0).unwrap();
    assert!((even.force_n() - 100.0).abs() < 1e-10);
    let pulling = even.scaled(-1.0).unwrap_err().to_string();
    assert!(pulling.starts_with("element 1 of"), "{pulling}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Force and moments of fields of any bolts are the bolts', whatever the mesh.
    #[test]
    fn fields_are_in_equilibrium(
        count in 1_usize..6,
        preloads in prop::collection::vec(100.0..50e3, 6),
        diameter_m in 0.005..0.02,
        clearance in 0.0..0.2,
        cells in prop::array::uniform2(30_usize..90),
        kind in 0..4,
    ) {
        let bolts = bolts_on_circle(count, 0.15, diameter_m, 1.0).unwrap();
        let bolts = with_preloads(&bolts, &preloads[..count]).unwrap();
        let zone = match kind {
            0 => polynomial(ThicknessRatio::Two, Reach::Rivets, ZoneForce::Preload),
            1 => polynomial(ThicknessRatio::One, Reach::Bolts, ZoneForce::Preload),
            2 => Zone::Cone(Cone { head_diameter_m: 1.6 * diameter_m, ..CONE }),
            _ => Zone::Cone(Cone {
                head_diameter_m: 1.6 * diameter_m,
                distribution: ConePressure::Uniform,
                ..CONE
            }),
        };
        let bolted = BoltedInterface {
            outline: Rectangle::centred(0.44, 0.43).unwrap(),
            cells,
            bolts: &bolts,
            clearance_m: clearance * diameter_m,
            zone,
        }
        .field()
        .unwrap();
        let balance = bolted.balance;
        prop_assert!(balance.force_imbalance().abs() < 1e-11);
        // Each cell's force acts at its middle; a cell is 5 to 15 mm wide.
        prop_assert!(balance.offset_m().iter().all(|offset| offset.abs() < 2e-3));
        for (share, bolt) in bolted.shares.iter().zip(&bolts) {
            prop_assert!((share.force_n / bolt.preload_n - 1.0).abs() < 1e-12);
        }
        let balanced = bolted
            .field
            .carrying(balance.preload_n, balance.preload_moments_n_m)
            .unwrap();
        let balance = Balance::of(&balanced.field, &bolts);
        prop_assert!(balance.force_imbalance().abs() < 1e-9);
        prop_assert!(balance.offset_m().iter().all(|offset| offset.abs() < 1e-9));
    }

    /// Whatever force and moment a contact can carry, it carries without pulling.
    #[test]
    fn contacts_do_not_pull(
        force_n in 1.0_f64..1e5,
        place in prop::array::uniform2(-0.95_f64..0.95),
        bolts in 1_usize..4,
    ) {
        let outline = Rectangle::centred(0.2, 0.1).unwrap();
        let bolts = bolts_in_rows([bolts, 1], [0.06, 0.0], 0.01, 8e3).unwrap();
        let with_bolts = BoltedInterface {
            outline,
            cells: [40, 20],
            bolts: &bolts,
            clearance_m: 0.001,
            zone: Zone::Cone(CONE),
        }
        .field()
        .unwrap();
        let even = PressureField::uniform(&outline, [40, 20], 5e3).unwrap();
        for (field, half_m) in [(&even, [0.1, 0.05]), (&with_bolts.field, [0.01, 0.01])] {
            let [x_m, y_m] = [place[0] * half_m[0], place[1] * half_m[1]];
            let moments = [force_n * y_m, -force_n * x_m];
            let found = field.carrying(force_n, moments).unwrap();
            let found = found.field;
            prop_assert!(found.elements().iter().all(|e| e.pressure_pa >= 0.0));
            prop_assert!((found.force_n() / force_n - 1.0).abs() < 1e-8);
            let [about_x, about_y] = found.moments_n_m();
            prop_assert!((about_x - moments[0]).abs() < 1e-8 * force_n);
            prop_assert!((about_y - moments[1]).abs() < 1e-8 * force_n);
            prop_assert!((found.area_m2() / field.area_m2() - 1.0).abs() < 1e-12);
        }
    }
}
