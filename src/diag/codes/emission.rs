//! Codes of 05: emission.

macro_rules! emission_codes {
    ($($rows:tt)*) => {
        libraries_codes! { $($rows)*
    "0501" Unmapped Error "the target has no spelling for this"
"The table of the target control has no row for something that the program needs: a code, a letter, a function, a register. Nothing is written in its place, so the program is refused.

The message names what is missing. If the machine has it, say so in its profile or in the table. If not, macroglot should have replaced it earlier: please report that."

    "0502" NestsTooDeep Error "brackets nest too deep"
"The expression needs more levels of brackets than the target control takes, counting those of functions and conditions.

Split the expression over two assignments in the source."

    "0503" NumberTooLong Error "the number has too many digits"
"The number has more digits than the target control takes, so it cannot be written without changing its value.

Round it in the source to what the machine needs."

    "0504" LineTooLong Error "the block is too long"
"The block has more characters than a line of the target control takes. Comments do not count: they get lines of their own.

Split the block in the source."

    "0505" NoSequenceNumber Error "no sequence number can be given"
"A block that a jump goes to needs a sequence number of its own. Either all numbers that the control takes are used, or two blocks need the same number, because a computed jump or a return fixes it.

Renumber the blocks of the source."

    "0506" TextUnwritable Error "the text cannot be written on the target"
"A line of output or a name has characters that the target control cannot write. The receiver would read something else.

Write it without these characters."

    "0507" MessageAltered Review "the message looks different on the target"
"A message to the operator has characters that the target control cannot write, and others take their place; or it is longer than the screen shows, and its end may be missing.

Check that the operator still understands it, or shorten it in the source."

    "0599" Internal Error "fault of macroglot itself"
"A check that macroglot makes of its own work failed: the program that it was about to write breaks a rule of its intermediate form or of the target's grammar. That program was not written, and no program that calls it. All others were, and are compared as usual.

Please report the program with this message."
        }
    };
}

pub(super) use emission_codes;
