//! Random sequences of calls: no crash, no leak, no broken promise, whatever the host does.
//!
//! `BOLTED_JOINT_CALLS` sets how many calls are made; `BOLTED_JOINT_SEED` the seed of the first sequence. A failure
//! names its seed: run that one sequence again with `BOLTED_JOINT_CALLS=1 BOLTED_JOINT_SEED=…`, which prints every call.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

// the functions come from the library's symbols
extern crate bolted_joint as _;

mod calls;
#[path = "../raw/mod.rs"]
mod raw;

use std::{env, fs, panic, path::Path, thread};

use calls::{Choices, Tally, World};

/// Turns in a sequence, which starts without instances and ends without any.
const TURNS: u64 = 1000;
/// Threads that make the calls.
const SHARES: u64 = 4;
/// Seed of the first sequence, if none is given.
const FIRST_SEED: u64 = 0xb017_0000;

fn number(variable: &str, otherwise: u64) -> u64 {
    let Ok(text) = env::var(variable) else {
        return otherwise;
    };
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u64::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.unwrap_or_else(|_| panic!("{variable} is \"{text}\", expected a whole number"))
}

fn prepare() {
    calls::write_resources(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("random calls"));
}

fn sequence(seed: u64, trace: bool) -> Tally {
    let outcome = panic::catch_unwind(|| {
        let mut choices = Choices::seeded(seed);
        let mut world = World::new(trace);
        for _ in 0..TURNS {
            world.turn(&mut choices);
        }
        world.finish()
    });
    outcome
        .unwrap_or_else(|_| panic!("repeat with BOLTED_JOINT_CALLS=1 BOLTED_JOINT_SEED={seed:#x}"))
}

fn sequences(first_seed: u64, calls: u64) -> Tally {
    let trace = calls == 1;
    let mut tally = Tally::default();
    let mut seed = first_seed;
    while tally.calls() < calls {
        tally.add(&sequence(seed, trace));
        seed += 1;
    }
    tally
}

/// Likewise in [`SHARES`], each with seeds of its own: the same calls on any number of processors.
fn shared(first_seed: u64, calls: u64) -> Tally {
    if calls < SHARES {
        return sequences(first_seed, calls);
    }
    let shares: Vec<Tally> = thread::scope(|scope| {
        let share = |number| move || sequences(first_seed + (number << 32), calls / SHARES);
        let threads: Vec<_> = (0..SHARES)
            .map(|number| scope.spawn(share(number)))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    let mut tally = Tally::default();
    shares.iter().for_each(|share| tally.add(share));
    tally
}

#[test]
fn a_million_random_calls_keep_every_promise() {
    prepare();
    let calls = number("BOLTED_JOINT_CALLS", 1_000_000);
    let tally = shared(number("BOLTED_JOINT_SEED", FIRST_SEED), calls);
    println!(
        "digest {:#x}: {} calls, {} failed simulations, {} forged states accepted, {} intermediate updates, {} refusals without a word",
        tally.digest,
        tally.calls(),
        tally.failures,
        tally.forged,
        tally.updates,
        tally.silent
    );
    for (name, [successes, warnings, refusals]) in &tally.by_function {
        println!("{name:45} {successes:8} ok {warnings:6} warnings {refusals:8} refused");
    }
    // the sequences are worth something only if they get everywhere
    if calls >= 100_000 {
        for name in calls::function_names() {
            let [successes, warnings, refusals] = tally.by_function[name];
            assert!(
                successes + warnings + refusals > 50,
                "{name} is hardly called"
            );
        }
        assert!(tally.forged > calls / 10_000, "{} states", tally.forged);
        assert!(tally.updates > calls / 1000, "{} updates", tally.updates);
        assert!(tally.silent > calls / 100, "{} in silence", tally.silent);
        assert!(
            tally.failures > calls / 10_000,
            "{} simulations failed",
            tally.failures
        );
    }
}

#[test]
fn sixteen_threads_get_the_bits_of_one() {
    prepare();
    let calls = number("BOLTED_JOINT_CALLS", 1_000_000);
    let of_seed = |seed| sequences(seed, (calls / 200).max(100));
    let one_by_one: Vec<Tally> = (0..16).map(of_seed).collect();
    let together: Vec<Tally> = thread::scope(|scope| {
        let threads: Vec<_> = (0..16)
            .map(|seed| scope.spawn(move || of_seed(seed)))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    assert_eq!(one_by_one, together);
    assert!(
        one_by_one
            .windows(2)
            .all(|pair| pair[0].digest != pair[1].digest)
    );
}

#[test]
fn bytes_from_a_fuzzer_make_calls_too() {
    prepare();
    let mut tally = Tally::default();
    for seed in 0..50 {
        let mut choices = Choices::seeded(seed);
        let bytes: Vec<u8> = (0..500)
            .flat_map(|_| choices.bits().to_le_bytes())
            .collect();
        tally.add(&World::new(false).exhaust(Choices::from_bytes(&bytes)));
    }
    assert!(tally.calls() > 5_000, "{} calls", tally.calls());
}

#[test]
fn damaged_start_files_are_refused_or_can_be_stepped() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("start files");
    fs::create_dir_all(&folder).unwrap();
    let mut choices = Choices::seeded(7);
    let mut accepted = 0;
    for round in 0..1500 {
        let mut bytes = choices.pick(&calls::MODELS).start_text().into_bytes();
        for _ in 0..round % 4 {
            let position = choices.bits() as usize % bytes.len();
            match choices.below(6) {
                0 => bytes.truncate(position.max(1)),
                1 => bytes[position] = choices.below(256) as u8,
                2 => bytes[position] = b"0123456789.-+eE \n"[choices.below(17)],
                3 => bytes.insert(position, choices.below(256) as u8),
                // a line twice, or an early end of a line
                4 => bytes.extend_from_within(position..),
                _ => {
                    drop(bytes.splice(position..position, choices.any_number().to_string().bytes()))
                }
            }
        }
        fs::write(folder.join("start.txt"), bytes).unwrap();
        accepted += u32::from(calls::live_from(&folder));
    }
    assert!((300..1400).contains(&accepted), "{accepted} accepted");
}

#[test]
fn forged_states_are_refused_or_can_be_gone_on_from() {
    prepare();
    let mut choices = Choices::seeded(11);
    let mut accepted = 0;
    for round in 0..3000 {
        let length = choices.below(if round % 2 == 0 { 40 } else { 256 });
        let bytes: Vec<u8> = (0..length).map(|_| choices.below(256) as u8).collect();
        accepted += u32::from(calls::go_on_from_forged_bytes(round as u8, &bytes));
    }
    assert!((1..3000).contains(&accepted), "{accepted} accepted");
}

/// No test of the library but of the tool that watches it: must fail under valgrind and AddressSanitizer.
#[test]
#[ignore = "does what must not be done, to see whether anybody notices"]
fn planted_read_beyond_an_array() {
    let array = vec![1_u8; 24].into_boxed_slice();
    // SAFETY: none: this is the fault that the tool must report
    let beyond = unsafe { array.as_ptr().add(array.len()).read_volatile() };
    println!("{beyond}");
}

/// As above.
#[test]
#[ignore = "does what must not be done, to see whether anybody notices"]
fn planted_leak() {
    // many, because the stack may still hold the last address
    for n in 0..100_u64 {
        std::hint::black_box(Box::leak(Box::new([n; 100])));
    }
}
