//! `reproduce`: published and obtained values for people and machines, and the documents that it writes.

use std::fs;
use std::path::Path;

use bolted_joint::reproduce::PublishedTable;
use bolted_joint_testing::{close, has, near};

use crate::bench::Bench;

fn document(name: &str) -> String {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    fs::read_to_string(docs.join(name)).unwrap()
}

#[test]
fn documents_are_what_the_command_writes() {
    let bench = Bench::new();
    for (case, name) in [
        ("kavi --figure kavi.svg", "kavi.md"),
        ("pirdayr", "pirdayr.md"),
        ("tian", "tian.md"),
        ("tol 2.2 --figure tol-friction.svg", "tol-friction.md"),
        ("zhao", "zhao.md"),
    ] {
        let written = bench.done(&format!("reproduce {case} --markdown")).stdout;
        assert_eq!(written, document(name), "{name}");
    }
    for figure in ["kavi.svg", "tol-friction.svg"] {
        assert_eq!(bench.text(figure), document(&format!("images/{figure}")));
    }
}

#[test]
fn quick_tables_are_in_the_document_as_the_command_writes_them() {
    let keys = ["4.2", "4.3", "4.30", "two-m6x30", "rotation"];
    let command = format!("reproduce --markdown {}", keys.join(" "));
    let written = Bench::new().done(&command).stdout;
    let document = document("tol.md");
    let before: Vec<&str> = document.split("\n## ").collect();
    let (first, tables) = written.split_once("\n## ").unwrap();
    assert_eq!(first, before[0]);
    let (contents, tables) = tables.split_once("\n## ").unwrap();
    assert!(contents.starts_with("Contents\n"));
    for line in contents.lines().filter(|line| line.starts_with('*')) {
        assert!(before[1].contains(line), "{line}");
    }
    let tables: Vec<&str> = tables.split("\n## ").map(str::trim).collect();
    assert_eq!(tables.len(), keys.len());
    for (key, table) in keys.into_iter().zip(tables) {
        let published: PublishedTable = key.parse().unwrap();
        assert!(table.starts_with(&published.to_string()), "{key}");
        assert!(
            before.iter().any(|section| section.trim() == table),
            "{key}"
        );
    }
}

#[test]
fn tables_are_printed_for_people_and_machines() {
    let bench = Bench::new();
    let command = "reproduce 4.2 --draws 3 --samples 4096";
    let text = bench.done(command).stdout;
    has(&text, &["published", "obtained", "2008", "Differences"]);
    has(&text, &["Not given in the thesis"]);
    let found = bench.done(&format!("{command} --json")).json();
    let row = &found[0]["rows"][0];
    assert_eq!(found[0]["table"], "4.2");
    assert_eq!(row["quantity"], "k_yy");
    assert_eq!(row["published"], 2008.0);
    assert_eq!(row["obtained"]["draws"], 3);
    for refused in ["reproduce 4.1", "reproduce 4.3 --json --markdown"] {
        assert_eq!(bench.run(refused).code, Some(2), "{refused}");
    }
}

#[test]
fn help_names_every_table() {
    let text = Bench::new().done("reproduce --help").stdout;
    for table in PublishedTable::ALL {
        has(&text, &[table.title(), table.key()]);
        has(&text, table.aliases());
    }
}

#[test]
fn cases_without_tables_stand_alone() {
    let bench = Bench::new();
    bench.fails("reproduce kavi 4.6", &["kavi: found 1 tables beside it"]);
    bench.fails("reproduce tian 4.2", &["1 tables beside it"]);
    bench.fails("reproduce pirdayr --figure x.svg", &["--figure"]);
    bench.fails("reproduce tol --figure x.svg", &["`kavi` or `2.2`"]);
    bench.fails("reproduce tol 2.2 4.6", &["2.2: found 1 tables beside it"]);
    bench.fails("reproduce tol kavi", &["kavi: found 1 tables beside it"]);
}

#[test]
fn json_of_kavi_has_every_specimen_and_claim() {
    let json = Bench::new().done("reproduce kavi --json").json();
    assert_eq!(json["specimens"].as_array().unwrap().len(), 22);
    let claims = json["claims"].as_array().unwrap();
    let opposite = claims.iter().filter(|claim| claim["verdict"] == "opposite");
    assert_eq!(opposite.count(), 1);
}

#[test]
fn json_of_tian_has_published_and_obtained_values_side_by_side() {
    let bench = Bench::new();
    let value = bench.done("reproduce tian --json").json();
    let fits = value["fits"].as_array().unwrap();
    assert_eq!(fits.len(), 3);
    for fit in fits {
        let layers = fit["layers"].as_array().unwrap();
        let printed = |layer: &serde_json::Value| layer["published_youngs_modulus_pa"].as_f64();
        let printed: Vec<f64> = layers.iter().filter_map(printed).collect();
        assert_eq!(printed, [0.352e9, 0.541e9, 0.885e9]);
        let mut ratios = layers.iter().map(|layer| &layer["poissons_ratio"]);
        assert!(ratios.all(serde_json::Value::is_number));
    }
    let text = bench.done("reproduce tian").stdout;
    has(&text, &["E obtained"]);
}

#[test]
fn joint_laws_of_tol_are_known_by_three_names_and_have_the_heat_of_closed_forms() {
    let bench = Bench::new();
    let json = bench.done("reproduce 2.2 --json").stdout;
    for name in ["tol 2.2", "2.2 tol", "tol-2.2"] {
        let same = bench.done(&format!("reproduce {name} --json")).stdout;
        assert_eq!(same, json, "{name}");
    }
    let found = bench.done("reproduce 2.2 --json").json();
    // mpmath: Iwan with 4000 N, 1.5e7 N/m, −0.3 and 0.5 at 1.5 φ_max; a slider of the same slip force and stiffness at 0.6 mm,
    // 4 · 4000 N (0.6 mm − 4000/1.5e7 m); Valanis with κ = 0.9, of forces 800 and lengths 4/75 times those of 1000, 100 and 5
    let expected = [
        ("iwan", "1.5 φ_max", 4.683_763_055_5),
        ("elasto_slip", "0.6 mm", 5.333_333_333_33),
        (
            "valanis",
            "κ = 0.9",
            0.018_574_814_300_601 * 800.0 * 4.0 / 75.0,
        ),
    ];
    let loops = found["loops"].as_array().unwrap();
    assert_eq!(loops.len(), 11);
    for (law, case, heat_j) in expected {
        let mut of = loops
            .iter()
            .filter(|of| of["law"] == law && of["case"] == case);
        let of = of.next().unwrap();
        close(of["heat_j"].as_f64().unwrap(), heat_j, 1e-9);
        assert!(of["parameters"][0]["printed"].is_null());
    }
    let text = bench.done("reproduce tol 2.2").stdout;
    has(
        &text,
        &["4.6838", "force at the tip", "the thesis prints none"],
    );
}

#[test]
fn zhao_is_printed_for_people_and_machines() {
    let bench = Bench::new();
    let json = bench.done("reproduce zhao --json").json();
    let rows = json["frequencies"].as_array().unwrap();
    assert_eq!(rows.len(), 18);
    // 556.5 over the measured 526.03 Hz; the paper prints 5.47 %
    assert_eq!(rows[0]["even"]["relative_to"], "computed");
    let percent = rows[0]["even"]["percent"].as_f64().unwrap();
    near(percent, 5.79, 0.005);
    let text = bench.done("reproduce zhao").stdout;
    has(&text, &["+5.47 % c", "+5.79 %", "Not given in the paper"]);
}

#[test]
fn a_name_that_is_none_brings_all_that_are() {
    let outcome = Bench::new().run("reproduce foo");
    assert_eq!(outcome.code, Some(2));
    has(
        &outcome.stderr,
        &[
            "4.2, 4.3",
            "m10x16, m8x16",
            "or tol for all of these, or one of 2.2, pirdayr, tian, kavi, zhao",
        ],
    );
}
