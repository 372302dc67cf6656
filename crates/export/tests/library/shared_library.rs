//! A shared library of any of the three formats, as far as the tests ask about it.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use object::elf;
use object::read::elf::{ElfFile64, FileHeader as _, ProgramHeader as _};
use object::read::{File, ImportFlags, Object as _};
use object::{Architecture, BinaryFormat, Endianness};

use crate::documented::glibc_version;

pub(crate) struct SharedLibrary {
    /// Platform as FMI 3.0 names it.
    pub(crate) platform: String,
    /// Names of the exported symbols.
    pub(crate) exports: Vec<String>,
    /// Names of the shared libraries that it asks for, sorted.
    pub(crate) needed: Vec<String>,
    /// Versioned symbols that it asks for, with their versions.
    versions: BTreeSet<(String, String)>,
    /// What its format could protect and it does not.
    pub(crate) weaknesses: Vec<String>,
    pub(crate) bytes: Vec<u8>,
}

impl SharedLibrary {
    pub(crate) fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let file = File::parse(bytes.as_slice()).unwrap();
        let mut needed: Vec<String> = file
            .import_libraries()
            .unwrap()
            .map(|library| text(library.unwrap().name()))
            .collect();
        needed.sort();
        needed.dedup();
        let exports = file
            .exports()
            .unwrap()
            .map(|export| text(export.unwrap().name().name().unwrap()))
            // Mach-O puts an underscore before every C name
            .map(|name| match file.format() {
                BinaryFormat::MachO => name.strip_prefix('_').unwrap().to_owned(),
                _ => name,
            })
            .collect();
        let mut versions = BTreeSet::new();
        for import in file.imports().unwrap() {
            let import = import.unwrap();
            if let ImportFlags::Elf {
                version: Some(version),
                ..
            } = import.flags()
            {
                versions.insert((text(import.name().name().unwrap()), text(version)));
            }
        }
        let weaknesses = match &file {
            File::Elf64(elf) => weaknesses_of_elf(elf),
            File::Pe64(pe) => weaknesses_of_pe(
                pe.nt_headers()
                    .optional_header
                    .dll_characteristics
                    .get(object::LittleEndian)
                    .0,
            ),
            _ => Vec::new(),
        };
        let platform = platform_of(&file);
        Self {
            platform,
            exports,
            needed,
            versions,
            weaknesses,
            bytes,
        }
    }

    /// Newest version of the GNU C library's symbols that the library asks for, and the symbols of that version.
    pub(crate) fn newest_glibc(&self) -> Option<((u32, u32), Vec<&str>)> {
        let newest = self
            .versions
            .iter()
            .filter_map(|(_, version)| glibc_version(version))
            .max()?;
        let symbols = self
            .versions
            .iter()
            .filter(|(_, version)| glibc_version(version) == Some(newest))
            .map(|(symbol, _)| symbol.as_str())
            .collect();
        Some((newest, symbols))
    }

    /// One line for the person who builds.
    pub(crate) fn summary(&self) -> String {
        let glibc = match self.newest_glibc() {
            Some(((major, minor), symbols)) => {
                format!(", newest GLIBC_{major}.{minor} ({})", symbols.join(" "))
            }
            None => String::new(),
        };
        format!(
            "{} bytes, {} functions exported, needs {}{glibc}",
            self.bytes.len(),
            self.exports.len(),
            self.needed.join(" ")
        )
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn platform_of(file: &File<'_>) -> String {
    let architecture = match file.architecture() {
        Architecture::X86_64 => "x86_64",
        Architecture::Aarch64 => "aarch64",
        other => panic!("architecture {other:?}"),
    };
    let system = match file.format() {
        BinaryFormat::Elf => "linux",
        BinaryFormat::MachO => "darwin",
        BinaryFormat::Pe => "windows",
        other => panic!("format {other:?}"),
    };
    format!("{architecture}-{system}")
}

/// Executable stack, data that stays writable after relocation, code that is relocated, lazy binding.
fn weaknesses_of_elf(elf: &ElfFile64<'_, Endianness>) -> Vec<String> {
    let endian = elf.endian();
    let mut found = Vec::new();
    let headers = elf.elf_program_headers();
    let of_kind = |kind| headers.iter().find(|header| header.p_type(endian) == kind);
    match of_kind(elf::PT_GNU_STACK) {
        Some(stack) if stack.p_flags(endian).0 & elf::PF_X.0 == 0 => {}
        _ => found.push("executable stack".to_owned()),
    }
    if of_kind(elf::PT_GNU_RELRO).is_none() {
        found.push("no read-only data after relocation (RELRO)".to_owned());
    }
    for header in headers {
        let flags = header.p_flags(endian).0;
        if flags & elf::PF_X.0 != 0 && flags & elf::PF_W.0 != 0 {
            found.push("segment both writable and executable".to_owned());
        }
    }
    let dynamic: Vec<_> = elf.elf_dynamic_table().unwrap().iter().collect();
    if !dynamic
        .iter()
        .any(|entry| entry.tag == elf::DT_FLAGS_1 && entry.val & elf::DF_1_NOW.0 != 0)
    {
        found.push("lazy binding: part of RELRO stays writable".to_owned());
    }
    for (tag, what) in [
        (elf::DT_TEXTREL, "relocations in code"),
        (elf::DT_RPATH, "search path (RPATH)"),
        (elf::DT_RUNPATH, "search path (RUNPATH)"),
    ] {
        if dynamic.iter().any(|entry| entry.tag == tag) {
            found.push(what.to_owned());
        }
    }
    assert_eq!(elf.elf_header().e_type(endian), elf::ET_DYN);
    found
}

/// Flags of the optional header that Windows needs to put the library at a random place and keep data from running.
fn weaknesses_of_pe(characteristics: u16) -> Vec<String> {
    [
        (0x0020, "no high-entropy address space"),
        (0x0040, "no random place (ASLR)"),
        (0x0100, "executable data (no DEP)"),
    ]
    .iter()
    .filter(|(flag, _)| characteristics & flag == 0)
    .map(|(_, what)| (*what).to_owned())
    .collect()
}
