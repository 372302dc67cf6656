/* Stands in, for platforms/try alone, for a library of Windows 10 that Wine has had since its version 9 only: Rust's
 * standard library asks it for the seed of its hash tables. */
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) {
    return RtlGenRandom(data, (ULONG)size);
}
