//! Codes of 02: dialects and machine profiles.

macro_rules! machines_codes {
    ($($rows:tt)*) => {
        lowering_codes! { $($rows)*
    "0201" UnconfirmedFact Review "no manual confirms this"
"The conversion depends on how a control behaves here, and no maker's text confirms it. The message names the fact and the control; `macroglot dialects` with the control's name prints the fact, and where it is from.

Check it on the machine or in its manual, then put it into the machine profile: a fact by its name in `confirm`, the answer to a question under `[behaviours]`, such as `divide.by.zero = \"alarm\"`. It is asked of the machine, once for all programs; a program is not for review because of it."

    "0202" DialectTable Error "a table of `dialects/` is wrong"
"A table of facts about a control contradicts itself, names something that does not exist, or has a key that nothing reads. Nothing is converted with a table that is wrong.

Correct the row shown. `dialects/README.md` says what the columns mean."

    "0203" MachineProfile Error "the machine profile is wrong"
"The profile of a machine has a key that nothing reads, a value that its control cannot have, or names a fact that its table does not hold. A setting that is not understood would make every conversion for that machine doubtful, so nothing is converted.

Correct the line shown. `macroglot dialects` lists what a control can be set to."

    "0204" CommonFact Note "common knowledge, and no manual was reached"
"The conversion depends on how a control behaves here. No text of its maker was reached that says so, and what the trade writes of it agrees: at least two sources that do not depend on each other, or one that reproduces a named manual. `macroglot dialects` with the control's name prints the fact, and the sources.

There is nothing to do as a rule. If your machine does otherwise, say so in its profile under `[behaviours]`; if you have checked it, put its name into `confirm`, and the note is gone."

    "0205" StartUnknown Review "what the machine starts in is not known"
"The program does not name a mode that counts in it, such as the unit of lengths, so it runs in the one that its machine is in when it starts. The profile of the machine that it was written for does not say which that is. The conversion leaves it so: it does the same on a machine that is in the same mode.

Say it in that profile: `units = \"inch\"` or `units = \"metric\"`. Every program of the machine is told it then."

    "0206" StartsStated Note "begins in what the machine's profile says"
"The program does not name all modes that count in it. It is run in what the machine begins in, as the machine's profile says under `[start]`. The codes are written at the head of the conversion, but for those that the target begins in too."

    "0207" MistakeOnly Note "what a mistake comes to is known of one control only"
"The program computes something that has no result for some values: a division by 0, the root of a negative number, an arc by its radius that ends where it starts. Of one of the two controls it is known what comes of it: an alarm, or, of such an arc, no move. Of the other no source says it. No program is meant to do so, and both controls do the same in every run without such a mistake, so nobody is asked.

There is nothing to do as a rule. Where the values come from an operator, test them before, and stop with an alarm of your own. A profile may say what the control does, as in `divide.by.zero = \"alarm\"` under `[behaviours]`; the note is gone then."
        }
    };
}

pub(super) use machines_codes;
