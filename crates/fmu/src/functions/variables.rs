//! Reading and writing variables.

use super::{Fmi2Boolean, Fmi2Integer, functions};
use crate::{
    abi::{
        Function, Opaque, Text, ValueReference, Way,
        arguments::{array, array_mut, same_count},
        call,
        handle::{Fmi3Boolean, Handle},
        shortcut::{arrays, arrays_mut, taken},
    },
    logging::Status,
};

/// Defines the functions for the type that all variables have, with the values and the length that is told of them.
macro_rules! accessors {
    ($(
        $(#[$doc:meta])*
        $name:ident($count:ident: usize, $($argument:ident: $type:ty),+) => $way:ident($values:ident, $told:ident);
    )*) => {$(
        $(#[$doc])*
        ///
        /// # Safety
        ///
        /// `instance` as for every function; the arrays have the lengths that are told.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(
            instance: Opaque,
            references: *const ValueReference,
            $count: usize,
            $($argument: $type),+
        ) -> Status {
            const FUNCTION: Function = Function::new(stringify!($name), Way::VALUES);
            // SAFETY: the importer's promise
            unsafe { $way(&FUNCTION, instance, (references, $count), ($values, $told)) }
        }
    )*};
}

accessors! {
    /// Reads variables of type Real.
    fmi2GetReal(count: usize, values: *mut f64) => get(values, count);
    /// Reads variables of type Float64.
    fmi3GetFloat64(count: usize, values: *mut f64, value_count: usize) => get(values, value_count);
    /// Sets variables of type Real, all or none.
    fmi2SetReal(count: usize, values: *const f64) => set(values, count);
    /// Sets variables of type Float64, all or none.
    fmi3SetFloat64(count: usize, values: *const f64, value_count: usize) => set(values, value_count);
}

/// Reads variables, the short way where it can be.
///
/// # Safety
///
/// As for [`fmi3GetFloat64`].
#[inline(always)]
unsafe fn get(
    function: &'static Function,
    instance: Opaque,
    (references, count): (*const ValueReference, usize),
    (values, value_count): (*mut f64, usize),
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        let shortcut = |handle: &mut Handle| {
            arrays_mut(references, values, count).is_some_and(|(references, values)| {
                handle.instance.get_between_steps(references, values)
            })
        };
        if value_count == count && taken(function.abi, instance, shortcut) {
            return Status::Ok;
        }
        get_the_long_way(instance, references, count, values, value_count, function)
    }
}

/// Its arguments stand in the order of the C function, so that the short way has none to move.
///
/// # Safety
///
/// As for [`fmi3GetFloat64`].
#[cold]
unsafe fn get_the_long_way(
    instance: Opaque,
    references: *const ValueReference,
    count: usize,
    values: *mut f64,
    value_count: usize,
    function: &'static Function,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call(*function, instance, |instance| {
            let words = instance.words();
            instance.require_readable()?;
            same_count("nValues", value_count, count)?;
            let references = array(references, count, words.references)?;
            instance.get(references, array_mut(values, count, words.values)?)
        })
    }
}

/// Sets variables, the short way where it can be.
///
/// # Safety
///
/// As for [`fmi3SetFloat64`].
#[inline(always)]
unsafe fn set(
    function: &'static Function,
    instance: Opaque,
    (references, count): (*const ValueReference, usize),
    (values, value_count): (*const f64, usize),
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        let shortcut = |handle: &mut Handle| {
            arrays(references, values, count).is_some_and(|(references, values)| {
                handle.instance.set_between_steps(references, values)
            })
        };
        if value_count == count && taken(function.abi, instance, shortcut) {
            return Status::Ok;
        }
        set_the_long_way(instance, references, count, values, value_count, function)
    }
}

/// # Safety
///
/// As for [`fmi3SetFloat64`].
#[cold]
unsafe fn set_the_long_way(
    instance: Opaque,
    references: *const ValueReference,
    count: usize,
    values: *const f64,
    value_count: usize,
    function: &'static Function,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call(*function, instance, |instance| {
            let words = instance.words();
            same_count("nValues", value_count, count)?;
            let references = array(references, count, words.references)?;
            instance.set(references, array(values, count, words.values)?)
        })
    }
}

/// Defines the functions for types that no variable has: they accept empty lists and refuse every variable.
macro_rules! other_types {
    ($($name:ident($asked:literal; $($argument:ident: $type:ty),*);)*) => {
        functions! {$(
            #[doc = concat!("Refuses every variable: none is of type ", $asked, ".")]
            $name(references: *const ValueReference, count: usize, $($argument: $type),*) => |instance| {
                let references = array(references, count, instance.words().references)?;
                instance.refuse_type(references, $asked)
            };
        )*}
    };
}

other_types! {
    fmi2GetInteger("Integer"; _values: *mut Fmi2Integer);
    fmi2GetBoolean("Boolean"; _values: *mut Fmi2Boolean);
    fmi2GetString("String"; _values: *mut Text);
    fmi2SetInteger("Integer"; _values: *const Fmi2Integer);
    fmi2SetBoolean("Boolean"; _values: *const Fmi2Boolean);
    fmi2SetString("String"; _values: *const Text);
    fmi3GetFloat32("Float32"; _values: *mut f32, _value_count: usize);
    fmi3GetInt8("Int8"; _values: *mut i8, _value_count: usize);
    fmi3GetUInt8("UInt8"; _values: *mut u8, _value_count: usize);
    fmi3GetInt16("Int16"; _values: *mut i16, _value_count: usize);
    fmi3GetUInt16("UInt16"; _values: *mut u16, _value_count: usize);
    fmi3GetInt32("Int32"; _values: *mut i32, _value_count: usize);
    fmi3GetUInt32("UInt32"; _values: *mut u32, _value_count: usize);
    fmi3GetInt64("Int64"; _values: *mut i64, _value_count: usize);
    fmi3GetUInt64("UInt64"; _values: *mut u64, _value_count: usize);
    fmi3GetBoolean("Boolean"; _values: *mut Fmi3Boolean, _value_count: usize);
    fmi3GetString("String"; _values: *mut Text, _value_count: usize);
    fmi3GetBinary("Binary"; _value_sizes: *mut usize, _values: *mut *const u8, _value_count: usize);
    fmi3GetClock("Clock"; _values: *mut Fmi3Boolean);
    fmi3SetFloat32("Float32"; _values: *const f32, _value_count: usize);
    fmi3SetInt8("Int8"; _values: *const i8, _value_count: usize);
    fmi3SetUInt8("UInt8"; _values: *const u8, _value_count: usize);
    fmi3SetInt16("Int16"; _values: *const i16, _value_count: usize);
    fmi3SetUInt16("UInt16"; _values: *const u16, _value_count: usize);
    fmi3SetInt32("Int32"; _values: *const i32, _value_count: usize);
    fmi3SetUInt32("UInt32"; _values: *const u32, _value_count: usize);
    fmi3SetInt64("Int64"; _values: *const i64, _value_count: usize);
    fmi3SetUInt64("UInt64"; _values: *const u64, _value_count: usize);
    fmi3SetBoolean("Boolean"; _values: *const Fmi3Boolean, _value_count: usize);
    fmi3SetString("String"; _values: *const Text, _value_count: usize);
    fmi3SetBinary("Binary"; _value_sizes: *const usize, _values: *const *const u8, _value_count: usize);
    fmi3SetClock("Clock"; _values: *const Fmi3Boolean);
}
