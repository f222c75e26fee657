//! What is written of a verification: outcomes, reasons, witnesses.

mod implicate;
mod library;
mod listing;
mod moment;
mod outcome;
mod program;
mod unconfirmed;

pub use implicate::implicate;
pub use library::{Certificate, Identity};
pub use listing::{Change, Listing, Seen};
pub use moment::Moment;
pub use outcome::{Outcome, Reason, Why};
pub use program::{Assumed, Edit, ProgramCertificate, Witness, differ};
pub use unconfirmed::OpenFact;
