//! Codes of 06: libraries and projects.

macro_rules! libraries_codes {
    ($($rows:tt)*) => {
        verification_codes! { $($rows)*
    "0601" OutsideLibrary Review "calls a program outside the library"
"The program calls one that is not among the converted files, or one that is refused and so not written. The call keeps its number. It is not known what the called program does: which variables it changes, which modes it leaves in force, whether it exists on the target.

Convert the whole library in one run, correct what is refused, or check the program on the target by hand. If the program stands in both machines and does the same there (probing, tool setting, the builder's own), name it under `programs` in the target's profile: it is asked no more, and runs on the emulated controls compare what each side gives it."

    "0602" TwinProgram Review "two programs have one number"
"Two programs of the library have the same number. A control holds only one program of a number, so the shop loads one or the other; the conversion cannot tell which.

Convert them apart, or give one another number. It is asked once for the library, and no program is for review because of it."

    "0603" AmbiguousCall Error "calls a number that two programs have"
"The program calls a number that two programs of the library have. The conversion cannot tell which one runs, and does not guess.

Convert the two in separate runs, each with its own callers."

    "0604" OutOfNumbers Error "no program number is free"
"A program that has no number on the source, or a subroutine that becomes a program of its own, needs a number on the target, and no number is free."

    "0605" Renumbered Note "a program gets another number"
"The number of the program is larger than the target control takes, so the program gets one that is free there. Or the program has no number, and the one that its file's name begins with (`1102-FLANSCH.NC`) is taken or not allowed there. Calls in the library that name it get the new number too; `macroglot.lock` keeps it for later runs.

Whoever selects the program at the machine, or calls it from outside the library, must use the new number."

    "0606" CalleeWithdrawn Error "calls a withdrawn program"
"The conversion of the called program does not do what its source does, as runs on the emulated controls show (MG0801). It is not written, and neither are its callers: they would run something else, or stop with an alarm. Other programs of the file and of the library are written.

Look at the named program first. Once it converts, so do its callers."

    "0607" StandsThere Note "calls a program that stands on the target"
"The program calls one that is not among the converted files and that the target's profile names under `programs`: it stands in the machine under that number, or under the one that the profile gives it, and does the same as on the source with the same arguments and variables. It is said once for the library.

What such a program changes is not known. Runs on the emulated controls compare what it is given, and go on with variables and a position drawn at random, the same on both sides."

    "0610" LockConflict Error "an earlier conversion has this register"
"`macroglot.lock` in the output folder keeps registers for programs that were converted before and are not part of this run. A program of this run needs one of them for itself: its variable has that number on both controls, or variables with computed numbers need a row of registers.

Convert the files that the message names together with these, in one run into the same folder: the variables then get other registers. Where the two do not run on one machine, give these another output folder. If a file that the message names is gone, `--prune` forgets it."

    "0611" LockChanged Note "a variable gets another register than before"
"An earlier run chose a register that a program of the library now needs for itself. All programs that rely on the choice are part of this run, so the variable gets another one, and all of them are written anew: with `--library` those too that were not named.

Load all of the programs into the machine. If a value in the old register matters, move it by hand."
        }
    };
}

pub(super) use libraries_codes;
