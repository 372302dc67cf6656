//! Random sequences of valid and invalid calls against a model of what must come out.

use std::ffi::c_void;

use crate::{
    c,
    importer::{Instance, Kind, TOKEN, vr},
};

/// xorshift64*: the same calls in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, limit: u64) -> u64 {
        (self.next() >> 33) % limit
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len() as u64) as usize]
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Instantiated,
    Initialization,
    Step,
    Terminated,
}

/// What the importer knows about an instance.
#[derive(Clone, Copy, Debug)]
struct Expected {
    mode: Mode,
    time: f64,
    force: f64,
    displacement: f64,
}

const FRESH: Expected = Expected {
    mode: Mode::Instantiated,
    time: 0.0,
    force: 0.0,
    displacement: 0.0,
};

struct Subject {
    instance: Instance,
    expected: Expected,
    saved: Option<(*mut c_void, Expected)>,
    /// All that the instance remembered after the last call.
    bytes: Vec<u8>,
}

impl Subject {
    fn new() -> Self {
        let instance = Instance::new(Kind::Lap, 2, &[]);
        let bytes = instance.state_bytes();
        Self {
            instance,
            expected: FRESH,
            saved: None,
            bytes,
        }
    }

    /// One random call; tells whether it was answered with an error.
    fn call(&mut self, random: &mut Random) -> bool {
        let expected = self.expected;
        let allowed = |modes: &[Mode]| modes.contains(&expected.mode);
        // mostly what makes sense next, so that the sequence gets somewhere
        let choice = match expected.mode {
            _ if random.one_in(3) => random.below(11),
            Mode::Instantiated => random.pick(&[0, 0, 4, 5]),
            Mode::Initialization => random.pick(&[1, 1, 4, 5]),
            Mode::Step => random.pick(&[10, 10, 10, 10, 4, 11]),
            Mode::Terminated => 3,
        };
        let (ok, status) = match choice {
            0 => {
                let start = if random.one_in(8) {
                    f64::NAN
                } else {
                    random.pick(&[0.0, 1.0, -2.5])
                };
                let ok = allowed(&[Mode::Instantiated]) && start.is_finite();
                if ok {
                    self.expected.mode = Mode::Initialization;
                    self.expected.time = start;
                }
                (ok, self.instance.enter_initialization(start, None))
            }
            1 => {
                let ok = allowed(&[Mode::Initialization]);
                if ok {
                    self.expected.mode = Mode::Step;
                }
                (ok, self.instance.exit_initialization())
            }
            2 if random.one_in(8) => {
                let ok = allowed(&[Mode::Step]);
                if ok {
                    self.expected.mode = Mode::Terminated;
                }
                (ok, self.instance.terminate())
            }
            3 if expected.mode == Mode::Terminated || random.one_in(16) => {
                self.expected = FRESH;
                (true, self.instance.reset())
            }
            4 => {
                let bad = random.one_in(8);
                let value = if bad {
                    f64::INFINITY
                } else {
                    random.pick(&[1.0, -50.0, 0.0, 200.0])
                };
                let other = if random.one_in(8) {
                    random.pick(&[vr::TIME, vr::JOINT_F, vr::NONE])
                } else {
                    random.pick(&[vr::B_F, vr::A_F, vr::K_YY])
                };
                let ok = !allowed(&[Mode::Terminated])
                    && value.is_finite()
                    && [vr::B_F, vr::A_F, vr::K_YY].contains(&other);
                let content = if other == vr::K_YY { 4e6 } else { 2.0 };
                if ok {
                    self.expected.force = if other == vr::A_F { content } else { value };
                }
                (ok, self.instance.set(&[vr::A_F, other], &[value, content]))
            }
            5 => {
                let ok = allowed(&[Mode::Instantiated, Mode::Initialization]);
                if ok {
                    self.expected.displacement = 1e-5;
                }
                (ok, self.instance.set(&[vr::A_Y], &[1e-5]))
            }
            6 => {
                let save = self.saved.is_none();
                if save {
                    self.saved = Some((self.instance.save(), expected));
                } else if let Some((state, _)) = self.saved.take() {
                    self.instance.free_state(state);
                }
                (true, c::OK)
            }
            7 => match self.saved {
                Some((state, saved)) => {
                    self.expected = saved;
                    (true, self.instance.restore(state))
                }
                None => (false, self.instance.restore(std::ptr::null_mut())),
            },
            8 if random.one_in(8) => {
                // SAFETY: the instance lives, the function refuses
                (false, unsafe {
                    c::fmi3EnterEventMode(self.instance.handle)
                })
            }
            9 if self.saved.is_some() => {
                let bytes = self
                    .saved
                    .map(|(state, _)| self.instance.serialize(state))
                    .unwrap();
                let mut damaged = bytes.clone();
                if random.one_in(2) {
                    let position = random.below(bytes.len() as u64) as usize;
                    damaged[position] ^= 1 << random.below(8);
                }
                let loaded = self.instance.deserialize(&damaged);
                if let Ok(state) = loaded {
                    self.instance.free_state(state);
                }
                (damaged == bytes, loaded.err().unwrap_or(c::OK))
            }
            11 if random.one_in(8) => {
                // a moment that no number can follow: the one kind of call that ends the simulation
                c::ok(self.instance.set(&[vr::B_M], &[f64::MAX]));
                let (status, last) = self.instance.step_to(expected.time, 1e-4);
                assert_eq!(last, expected.time);
                self.expected.mode = Mode::Terminated;
                (false, status)
            }
            _ => {
                let h = if random.one_in(16) {
                    random.pick(&[0.0, -1.0, f64::NAN])
                } else {
                    random.pick(&[1e-4, 3e-5, 1e-3])
                };
                let t = if random.one_in(20) {
                    expected.time + 1.0
                } else {
                    expected.time
                };
                let ok = allowed(&[Mode::Step]) && h > 0.0 && t == expected.time;
                let (status, last) = self.instance.step_to(t, h);
                if ok {
                    self.expected.time = t + h;
                }
                assert_eq!(last, self.expected.time);
                // where it moves to is the business of other tests
                [self.expected.displacement] = self.instance.get([vr::A_Y]);
                (ok, status)
            }
        };
        assert_eq!(status, if ok { c::OK } else { c::ERROR }, "{expected:?}");
        !ok
    }

    /// The instance is where the importer thinks it is.
    fn check(&mut self, before: Mode, refused: bool) {
        let Expected {
            mode,
            time,
            force,
            displacement,
        } = self.expected;
        // the layout of the bytes: header, version, length of the token, token, FMI version, kind, DOFs, joint (four bytes),
        // interface type, mode
        let bytes = self.instance.state_bytes();
        assert_eq!(bytes[8 + 4 + 4 + TOKEN.len() + 8], mode as u8);
        if refused && mode == before {
            assert!(bytes == self.bytes, "a refused call changed the instance");
        }
        self.bytes = bytes;
        assert_eq!(
            self.instance.get([vr::TIME, vr::A_F, vr::A_Y]),
            [time, force, displacement]
        );
        // all but the accelerations, which a moment that no number can follow has made overflow
        let all: Vec<u32> = (0..vr::A_ACCELERATION).collect();
        assert!(
            self.instance
                .try_get(&all)
                .unwrap()
                .iter()
                .all(|value| value.is_finite())
        );
        let log = self.instance.take_log();
        let errors = log
            .iter()
            .filter(|message| message.status == c::ERROR)
            .count();
        assert_eq!(errors, usize::from(refused), "{log:?}");
    }
}

#[test]
fn a_hundred_thousand_random_calls() {
    let mut random = Random(0x5eed_0fb0_17ed);
    let mut subjects: Vec<Subject> = (0..4).map(|_| Subject::new()).collect();
    let (mut steps, mut refusals, mut failures) = (0, 0, 0);
    for _ in 0..100_000 {
        let index = random.below(subjects.len() as u64) as usize;
        if random.one_in(500) {
            // a new instance in place of an old one
            if let Some((state, _)) = subjects[index].saved.take() {
                subjects[index].instance.free_state(state);
            }
            subjects[index] = Subject::new();
        }
        let subject = &mut subjects[index];
        let before = subject.expected;
        let refused = subject.call(&mut random);
        subject.check(before.mode, refused);
        let failed = refused && subject.expected.mode != before.mode;
        refusals += u32::from(refused && !failed);
        failures += u32::from(failed);
        steps +=
            u32::from(subject.expected.mode == Mode::Step && subject.expected.time > before.time);
    }
    // the sequence is worth something only if it gets everywhere
    assert!(
        steps > 10_000 && refusals > 10_000 && failures > 500,
        "{steps} steps, {refusals} refusals, {failures} failures"
    );
    for subject in &mut subjects {
        if let Some((state, _)) = subject.saved.take() {
            subject.instance.free_state(state);
        }
    }
}
