//! The functions of Model Exchange with slices in place of pointers.

use super::{Instance, Kind};
use crate::c;

impl Instance {
    pub(crate) fn enter_event(&mut self) -> i32 {
        // SAFETY: the instance lives
        unsafe { c::fmi3EnterEventMode(self.handle) }
    }

    pub(crate) fn enter_continuous(&mut self) -> i32 {
        // SAFETY: the instance lives
        unsafe { c::fmi3EnterContinuousTimeMode(self.handle) }
    }

    pub(crate) fn update(&mut self) -> i32 {
        let (mut flags, mut time) = ([true; 5], f64::NAN);
        let [a, b, c, d, e] = flags.each_mut().map(|flag| flag as *mut bool);
        // SAFETY: the instance lives, all pointers are to locals
        let status =
            unsafe { c::fmi3UpdateDiscreteStates(self.handle, a, b, c, d, e, &raw mut time) };
        if status == c::OK {
            assert_eq!((flags, time), ([false; 5], 0.0));
        }
        status
    }

    pub(crate) fn complete_step(&mut self) -> i32 {
        let (mut event, mut end) = (true, true);
        // SAFETY: the instance lives, all pointers are to locals
        let status = unsafe {
            c::fmi3CompletedIntegratorStep(self.handle, true, &raw mut event, &raw mut end)
        };
        assert!(status != c::OK || !event && !end);
        status
    }

    pub(crate) fn set_time(&mut self, time: f64) -> i32 {
        // SAFETY: the instance lives
        unsafe { c::fmi3SetTime(self.handle, time) }
    }

    pub(crate) fn set_states(&mut self, states: &[f64]) -> i32 {
        // SAFETY: the instance lives, pointer and length are those of a slice
        unsafe { c::fmi3SetContinuousStates(self.handle, states.as_ptr(), states.len()) }
    }

    pub(crate) fn read(
        &mut self,
        function: unsafe extern "C" fn(*mut std::ffi::c_void, *mut f64, usize) -> i32,
        count: usize,
    ) -> Result<Vec<f64>, i32> {
        let mut numbers = vec![f64::NAN; count];
        // SAFETY: the instance lives, pointer and length are those of a slice
        let status = unsafe { function(self.handle, numbers.as_mut_ptr(), count) };
        (status == c::OK).then_some(numbers).ok_or(status)
    }

    pub(crate) fn states(&mut self, count: usize) -> Vec<f64> {
        self.read(c::fmi3GetContinuousStates, count).unwrap()
    }

    pub(crate) fn derivatives(&mut self, count: usize) -> Vec<f64> {
        self.read(c::fmi3GetContinuousStateDerivatives, count)
            .unwrap()
    }

    /// Instance in Continuous-Time Mode at t = 0.
    pub(crate) fn continuous(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let mut instance = Self::exchanging(kind, dofs, changes);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        assert_eq!(instance.update(), c::OK);
        assert_eq!(instance.enter_continuous(), c::OK);
        instance.take_log();
        instance
    }
}
