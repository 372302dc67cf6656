//! The date in an FMU or on a page: given by the environment where builds are to be reproducible, else the present time.

use std::env;
use std::fmt;
use std::time::{SystemTime, UNIX_EPOCH};

use thiserror::Error;

/// Last second of the year 9999, the last that FMI's date format holds.
const LATEST: u64 = 253_402_300_799;

/// The environment variable for reproducible dates is malformed.
#[derive(Debug, Error)]
#[error(
    "SOURCE_DATE_EPOCH: found {found:?}, expected seconds since 1970-01-01T00:00:00Z as a whole number \
     up to the year 9999; unset it for the present time"
)]
pub struct DateError {
    /// What stands there.
    pub found: String,
}

/// A moment in UTC, to the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Timestamp {
    unix_s: u64,
}

/// A moment by calendar and clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Civil {
    /// Year of the Gregorian calendar.
    pub year: u16,
    /// Month, from 1.
    pub month: u8,
    /// Day of the month, from 1.
    pub day: u8,
    /// Hour, from 0.
    pub hour: u8,
    /// Minute, from 0.
    pub minute: u8,
    /// Second, from 0.
    pub second: u8,
}

impl Timestamp {
    /// `SOURCE_DATE_EPOCH` where it is set, else the present time.
    ///
    /// # Errors
    ///
    /// [`DateError`] where the variable is not a number of seconds.
    pub fn from_environment() -> Result<Self, DateError> {
        match env::var_os("SOURCE_DATE_EPOCH") {
            None => Ok(Self::now()),
            Some(text) => Self::from_epoch_text(&text.to_string_lossy()),
        }
    }

    /// A moment by the decimal number of seconds since 1970-01-01T00:00:00Z, as in `SOURCE_DATE_EPOCH`.
    ///
    /// # Errors
    ///
    /// [`DateError`] where `text` is not such a number.
    pub fn from_epoch_text(text: &str) -> Result<Self, DateError> {
        let digits_only = text.bytes().all(|byte| byte.is_ascii_digit());
        text.parse()
            .ok()
            .filter(|unix_s| digits_only && *unix_s <= LATEST)
            .map(|unix_s| Self { unix_s })
            .ok_or_else(|| DateError {
                found: text.to_owned(),
            })
    }

    fn now() -> Self {
        // A clock before 1970 is not set; the epoch is as good as any date then.
        let since = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        Self {
            unix_s: since.as_secs().min(LATEST),
        }
    }

    /// Days to the proleptic Gregorian calendar, counted in 400-year cycles from 1 March of year 0.
    #[must_use]
    pub fn civil(self) -> Civil {
        let (days, seconds) = (self.unix_s / 86_400, self.unix_s % 86_400);
        let days = days + 719_468;
        let (cycle, day_of_cycle) = (days / 146_097, days % 146_097);
        let year_of_cycle = (day_of_cycle - day_of_cycle / 1460 + day_of_cycle / 36_524
            - day_of_cycle / 146_096)
            / 365;
        let day_of_year =
            day_of_cycle - (365 * year_of_cycle + year_of_cycle / 4 - year_of_cycle / 100);
        // Months from March have 153 days in five.
        let month_from_march = (5 * day_of_year + 2) / 153;
        let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
        let month = if month_from_march < 10 {
            month_from_march + 3
        } else {
            month_from_march - 9
        };
        let year = 400 * cycle + year_of_cycle + u64::from(month <= 2);
        Civil {
            year: year as u16,
            month: month as u8,
            day: day as u8,
            hour: (seconds / 3600) as u8,
            minute: (seconds / 60 % 60) as u8,
            second: (seconds % 60) as u8,
        }
    }
}

/// FMI's format, such as `2009-12-08T14:33:22Z`.
impl fmt::Display for Timestamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = self.civil();
        write!(
            f,
            "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z",
            at.year, at.month, at.day, at.hour, at.minute, at.second
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_gregorian_calendar() {
        // Reference: date -u -d @SECONDS
        for (unix_s, expected) in [
            ("0", "1970-01-01T00:00:00Z"),
            ("951782400", "2000-02-29T00:00:00Z"),
            ("1260282802", "2009-12-08T14:33:22Z"),
            ("4107542399", "2100-02-28T23:59:59Z"),
            ("4107542400", "2100-03-01T00:00:00Z"),
            ("253402300799", "9999-12-31T23:59:59Z"),
        ] {
            assert_eq!(
                Timestamp::from_epoch_text(unix_s).unwrap().to_string(),
                expected
            );
        }
    }

    #[test]
    fn malformed_epochs_are_refused() {
        for text in ["", "-1", "+1", "1.5", "yesterday", " 1", "253402300800"] {
            let message = Timestamp::from_epoch_text(text).unwrap_err().to_string();
            assert!(
                message.starts_with(&format!(
                    "SOURCE_DATE_EPOCH: found {text:?}, expected seconds"
                )),
                "{message}"
            );
        }
    }
}
