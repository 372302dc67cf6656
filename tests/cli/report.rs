//! The report: what it says of studies that are harder than the demo's, and that no text of a user's gets out of its place.

use bolted_joint_testing::has;

use crate::bench::IDENTIFY;
use crate::rig::{self, ACTIVE, functions_of, ready, study};

/// What stands between a heading and the next one of its rank.
fn section<'a>(page: &'a str, heading: &str) -> &'a str {
    let (_, rest) = page.split_once(&format!("<h2>{heading}</h2>")).unwrap();
    rest.split("<h2>").next().unwrap()
}

#[test]
fn texts_of_the_user_stay_texts() {
    let bench = ready();
    let texts = "name = '</title></script><script>alert(1)</script>&amp;\"'\nnotes = ['<img src=x onerror=alert(2)>']";
    bench.edit("study.toml", "name = \"two bodies\"", texts);
    let page = bench.report();
    assert!(!page.contains("<script>alert") && !page.contains("<img"));
    let heading = "<h1>&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;amp;&quot;</h1>";
    has(&page, &[heading, "&lt;img src=x onerror=alert(2)&gt;"]);
}

#[test]
fn the_same_study_gives_the_same_page_at_the_same_time() {
    let bench = ready();
    let write = |name: &str| {
        let mut command = bench.command(&format!("{IDENTIFY} --report {name}"));
        let status = command.env("SOURCE_DATE_EPOCH", "1700000000").output();
        assert!(status.unwrap().status.success());
        bench.text(name)
    };
    let page = write("o.html");
    assert!(page.contains("<time>2023-11-14T22:13:20Z</time>"));
    assert!(page == write("p.html"));
}

#[test]
fn a_parameter_that_is_not_identified_is_named_without_a_number() {
    let bench = ready();
    // Errors far beyond the receptance: the lines say next to nothing.
    let text = study("full", &[23]) + "\n[noise]\nrelative = 300\nfloor = 0\n";
    bench.write("study.toml", text);
    let page = bench.report_not_to_be_relied_on("the data do not determine k_yy and k_thetatheta");
    let open = bench.json("o.joint.json")["uncertainty"]["not_identified"].clone();
    let open = open.as_array().unwrap().len();
    assert!(open > 0);
    let parameters = section(&page, "Identified parameters");
    let cells = parameters.matches("<td class=\"open\" colspan=\"2\">not identified</td>");
    assert_eq!(cells.count(), open);
    assert!(parameters.contains("<p class=\"warning\">Not identified: <i>"));
    assert!(page.contains(&format!("{open} of 6 parameters are not identified")));
    let lines = section(&page, "Stiffness and damping line by line");
    assert_eq!(lines.matches("is not identified.").count(), open);
}

#[test]
fn an_active_estimate_stands_beside_the_passive_one() {
    let page = rig::of(&ACTIVE, "full").report();
    let fit = section(&page, "How well it fits");
    assert!(fit.contains("<th>Free estimate</th><th>Passive estimate</th>"));
    let row = fit.split("<i>c</i><sub>yθ</sub></th>").nth(1).unwrap();
    assert!(row.starts_with("<td class=\"number\">0.3</td>"), "{row}");
    assert!(section(&page, "Identified parameters").contains("The free estimate is not passive."));
}

#[test]
fn several_assemblies_and_missing_pairs_are_told_apart() {
    let bench = ready();
    let one = "[assembly]\nfrf = \"c.uff\"\npoints = [\"21:+Y\", \"22:+Y\", \"23:+Y\"]";
    let several = "[[assembly]]\nfrf = \"c.uff\"\npoints = [\"21:+Y\", \"22:+Y\"]\ntorque = 10\n\
                   [[assembly]]\nfrf = \"c.uff\"\npoints = [\"21:+Y\", \"22:+Y\", \"23:+Y\"]\ntorque = 20";
    bench.edit("study.toml", one, several);
    let page = bench.report();
    assert!(page.contains("tightened to 10 N·m") && page.contains("tightened to 20 N·m"));
    // 4 and 9 functions, 9 drawn: as many of each as can be.
    let functions = section(&page, "Frequency response functions");
    assert!(functions.contains("9 of 13 functions are drawn below"));
    for (assembly, drawn) in [(1, 4), (2, 5)] {
        let id = format!("id=\"frf-{assembly}-");
        assert_eq!(functions.matches(&id).count(), drawn);
    }
    assert_eq!(functions.matches("<td>2</td>").count(), 9);
    // Sensitivities are drawn for each.
    let sensitivities = section(&page, "Sensitivity of the receptances to the parameters");
    for assembly in [1, 2] {
        assert!(sensitivities.contains(&format!("<h3>Assembly {assembly}</h3>")));
        let id = format!("id=\"sensitivity-{assembly}-");
        assert_eq!(sensitivities.matches(&id).count(), 3);
    }
}

#[test]
fn a_single_column_has_no_decoupling_and_says_so() {
    let bench = ready();
    let column = functions_of(&bench.text("c.uff"), |place| place % 3 == 0);
    bench.write("c.uff", column);
    let page = bench.report();
    let lines = section(&page, "Stiffness and damping line by line");
    assert!(lines.contains("There is no decoupling") && !lines.contains("<figure"));
    assert!(page.contains("<b>Before using the result</b>"));
}

#[test]
fn a_report_needs_a_name_of_its_own() {
    let bench = ready();
    let with = |name| format!("{IDENTIFY} --report {name}");
    bench.refused(&with("o.pdf"), &["--report", "o.pdf", ".html"]);
    bench.refused(&with("no-such-folder/o.html"), &["no-such-folder"]);
    bench.write("both.html", "");
    let same = "identify study.toml -o both.html --report both.html";
    bench.refused(same, &["both.html", "same file"]);
    let mut command = bench.command(&with("o.html"));
    command.env("SOURCE_DATE_EPOCH", "yesterday");
    bench.refused_by(&mut command, &["SOURCE_DATE_EPOCH", "yesterday"]);
}
