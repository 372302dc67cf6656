use bolted_joint::predict::layered_beam::Study;
#[test]
fn try_it() {
    let s = Study::read(std::path::Path::new("/tmp/s1.toml")).unwrap();
    let o = s.run().unwrap();
    for l in o.summary() {
        println!("{l}");
    }
    for l in o.warnings() {
        println!("W {l}");
    }
    println!("{}", o.csv());
    println!("{}", o.joint_file().to_json().unwrap());
}
