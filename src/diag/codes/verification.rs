//! Codes of 08: emulated controls and verification.

macro_rules! verification_codes {
    ($($rows:tt)*) => {
        checks_codes! { $($rows)*
    "0801" VerifiedDifferent Error "the conversion differs from its source"
"Source and conversion were run on their emulated controls, and they do not do the same. The message names the first difference; the certificate has the start values, both blocks and both events. The program is not written, and neither are its callers (MG0606); other programs of its file are. The certificate is `NAME.not-written.json` in the output folder.

The fault is in the conversion, in an emulated control, or in the table of a control. Please report the program with its certificate."

    "0802" NotDecided Review "verification is not complete"
"Source and conversion were run on their emulated controls, and no difference was found. But part of the program was not decided: a branch that no scenario reached, a run that did not end, a called program that is not in the library, an unconfirmed fact that mattered. The message says which.

Check the places that the message names, or add what is missing to the machine profile, and run `macroglot verify` again."

    "0803" RoundingSensitive Review "rounding may decide a comparison"
"A comparison of computed values is so close that the last digit decides it. If the target computes with fewer digits, or errs in the last one, the machine does something else. Two controls of the same make can differ here.

Add a tolerance to the comparison in the source, or round before it."

    "0804" AlarmRaised Error "the program ends in an alarm"
"The program was run on its emulated control, which stopped with an alarm here. The message has the alarm's text, and its number on the control if a source names it. If the program itself gave the number, it is shown with what the control adds to it.

If the alarm is the program's own check, run it with the values that it wants: `--set '#1=2.5'`."

    "0805" NoEnd Error "the program does not end"
"The program was run on its emulated control and used up its limit of blocks, events or time. The place shows where it was then. A loop that waits for an input, or a main program that starts again, runs for ever without a person at the machine.

Look for the loop at this place; a scenario file can set inputs. If the program is only long, raise the limit with `--steps`."

    "0806" CannotRun Error "the program cannot be run"
"The emulated control met a block that it cannot read or run, or a call of a program that it does not have.

Name the files of called programs with `--library`."

    "0807" NotRun Note "numbers in the program decide a branch"
"A branch of the program always goes one way, whatever the machine or the operator gives it: only other numbers in its own text would send it the other way. Other numbers were tried at its head, on both sides, and none went there, so no run shows what the conversion does there. The program as it stands does the same on both sides.

If you change such a number on the machine, read first what stands after that branch, or convert the program with the new number."

    "0808" SourceStops Note "the old machine stops where the new one goes on"
"If a caller gave this program some values, as an offset number that is not there, the source's control would stop with an alarm of its own. The target does not stop, or stops elsewhere. Values with which the old machine ran are not concerned: runs with those went every way, and both sides did the same.

Nothing needs to be done for the programs of the library. Who writes a new call must not give such values, or let the program check them first."
        }
    };
}

pub(super) use verification_codes;
