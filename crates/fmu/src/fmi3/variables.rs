//! Reading and writing variables.

use std::ffi::c_char;

use crate::{
    abi::{
        handle::Handle,
        shortcut::{arrays, arrays_mut, taken},
    },
    fmi3::{
        Boolean, Done, Opaque, ValueReference,
        arguments::{array, array_mut, same_count},
        call, call_inside,
    },
    logging::Status,
    version::Abi,
};

/// Reads variables of type Float64, which is that of all variables.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the lengths that are told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    instance: Opaque,
    value_references: *const ValueReference,
    value_reference_count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        let shortcut = |handle: &mut Handle| {
            arrays_mut(value_references, values, value_count).is_some_and(|(references, values)| {
                handle.instance.get_between_steps(references, values)
            })
        };
        if value_count == value_reference_count && taken(Abi::Fmi3, instance, shortcut) {
            return Status::Ok;
        }
        get_float64(
            instance,
            value_references,
            value_reference_count,
            values,
            value_count,
        )
    }
}

/// # Safety
///
/// As for [`fmi3GetFloat64`].
#[cold]
unsafe fn get_float64(
    instance: Opaque,
    value_references: *const ValueReference,
    value_reference_count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call_inside("fmi3GetFloat64", instance, |instance| {
            same_count("nValues", value_count, value_reference_count)?;
            let references = array(value_references, value_reference_count, "valueReferences")?;
            let values = array_mut(values, value_count, "values")?;
            instance.get(references, values)?;
            Ok(Done::Silently)
        })
    }
}

/// Sets variables of type Float64, all or none.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the lengths that are told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    instance: Opaque,
    value_references: *const ValueReference,
    value_reference_count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        let shortcut = |handle: &mut Handle| {
            arrays(value_references, values, value_count).is_some_and(|(references, values)| {
                handle.instance.set_between_steps(references, values)
            })
        };
        if value_count == value_reference_count && taken(Abi::Fmi3, instance, shortcut) {
            return Status::Ok;
        }
        set_float64(
            instance,
            value_references,
            value_reference_count,
            values,
            value_count,
        )
    }
}

/// # Safety
///
/// As for [`fmi3SetFloat64`].
#[cold]
unsafe fn set_float64(
    instance: Opaque,
    value_references: *const ValueReference,
    value_reference_count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call_inside("fmi3SetFloat64", instance, |instance| {
            same_count("nValues", value_count, value_reference_count)?;
            let references = array(value_references, value_reference_count, "valueReferences")?;
            let values = array(values, value_count, "values")?;
            instance.set(references, values)?;
            Ok(Done::Silently)
        })
    }
}

/// Defines the functions for types that no variable has: they accept empty lists and refuse every variable.
macro_rules! other_types {
    ($($function:ident($asked:literal; $($argument:ident: $type:ty),*);)*) => {$(
        #[doc = concat!("Refuses every variable: none is of type ", $asked, ".")]
        ///
        /// # Safety
        ///
        /// `instance` as for every function; the value references have the length that is told.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $function(
            instance: Opaque,
            value_references: *const ValueReference,
            value_reference_count: usize,
            $($argument: $type),*
        ) -> Status {
            $(let _ = $argument;)*
            // SAFETY: the importer's promise
            unsafe {
                call(stringify!($function), instance, |instance| {
                    let references = array(value_references, value_reference_count, "valueReferences")?;
                    instance.refuse_type(references, $asked)?;
                    Ok(Done::Silently)
                })
            }
        }
    )*};
}

other_types! {
    fmi3GetFloat32("Float32"; _values: *mut f32, _value_count: usize);
    fmi3GetInt8("Int8"; _values: *mut i8, _value_count: usize);
    fmi3GetUInt8("UInt8"; _values: *mut u8, _value_count: usize);
    fmi3GetInt16("Int16"; _values: *mut i16, _value_count: usize);
    fmi3GetUInt16("UInt16"; _values: *mut u16, _value_count: usize);
    fmi3GetInt32("Int32"; _values: *mut i32, _value_count: usize);
    fmi3GetUInt32("UInt32"; _values: *mut u32, _value_count: usize);
    fmi3GetInt64("Int64"; _values: *mut i64, _value_count: usize);
    fmi3GetUInt64("UInt64"; _values: *mut u64, _value_count: usize);
    fmi3GetBoolean("Boolean"; _values: *mut Boolean, _value_count: usize);
    fmi3GetString("String"; _values: *mut *const c_char, _value_count: usize);
    fmi3GetBinary("Binary"; _value_sizes: *mut usize, _values: *mut *const u8, _value_count: usize);
    fmi3GetClock("Clock"; _values: *mut Boolean);
    fmi3SetFloat32("Float32"; _values: *const f32, _value_count: usize);
    fmi3SetInt8("Int8"; _values: *const i8, _value_count: usize);
    fmi3SetUInt8("UInt8"; _values: *const u8, _value_count: usize);
    fmi3SetInt16("Int16"; _values: *const i16, _value_count: usize);
    fmi3SetUInt16("UInt16"; _values: *const u16, _value_count: usize);
    fmi3SetInt32("Int32"; _values: *const i32, _value_count: usize);
    fmi3SetUInt32("UInt32"; _values: *const u32, _value_count: usize);
    fmi3SetInt64("Int64"; _values: *const i64, _value_count: usize);
    fmi3SetUInt64("UInt64"; _values: *const u64, _value_count: usize);
    fmi3SetBoolean("Boolean"; _values: *const Boolean, _value_count: usize);
    fmi3SetString("String"; _values: *const *const c_char, _value_count: usize);
    fmi3SetBinary("Binary"; _value_sizes: *const usize, _values: *const *const u8, _value_count: usize);
    fmi3SetClock("Clock"; _values: *const Boolean);
}
