//! The catalogue. Everything that is said of a code anywhere (`macroglot
//! explain`, `docs/diagnostics.md`, SARIF rules) comes from its row here.
//!
//! Codes are grouped by the part of the line that finds them: 01 text and
//! syntax, 02 dialects and machine profiles, 03 lowering, 04 legalization,
//! 05 emission, 06 libraries and projects, 07 the command line, 08 emulated
//! controls and verification. A number is never used again.

use super::Severity;

macro_rules! codes {
    ($($number:literal $name:ident $severity:ident $title:literal $page:literal)*) => {
        /// The code of a diagnostic.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = $title] $name,)*
        }

        /// Every code, in order.
        pub const ALL: &[Code] = &[$(Code::$name),*];

        impl Code {
            /// Its number as users see it: `MG0101`.
            pub const fn number(self) -> &'static str {
                match self { $(Code::$name => concat!("MG", $number),)* }
            }

            /// How grave it is.
            pub const fn severity(self) -> Severity {
                match self { $(Code::$name => Severity::$severity,)* }
            }

            /// What it is, in a few words.
            pub const fn title(self) -> &'static str {
                match self { $(Code::$name => $title,)* }
            }

            /// Its page: what happened, why it matters, what to do.
            pub const fn page(self) -> &'static str {
                match self { $(Code::$name => $page,)* }
            }
        }
    };
}

impl Code {
    /// The code with this number (`MG0101`, case and the letters MG left free).
    pub fn find(number: &str) -> Option<Code> {
        let digits = number.trim().trim_start_matches(['M', 'm', 'G', 'g']);
        ALL.iter().copied().find(|code| &code.number()[2..] == digits)
    }
}

impl serde::Serialize for Code {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.number())
    }
}

codes! {
    // ---- 01: text and syntax ----
    "0101" Unreadable Error "block cannot be read"
"The block does not follow the grammar of its control, so nothing is known of what it does. Its bytes are kept. A program with such a block is refused, because a conversion would have to leave it out.

Correct the block; the place shown is where reading stopped."

    "0111" NestedComment Error "comment inside a comment"
"A comment ends at the first `)`. A second `(` inside it opens nothing, so that what stands behind the first `)` is read as code.

Use other signs inside the comment."

    "0112" UnbalancedBracket Error "brackets do not match"
"A `[` is never closed, or a `]` closes nothing. Which expression was meant cannot be known.

Add or remove the bracket shown."

    "0114" BracketDepth Error "too many brackets inside one another"
"The control allows only so many levels of brackets, those of functions included, and stops with an alarm at one more.

Compute a part of the expression in a block before."

    "0115" TooManyDigits Error "too many digits"
"The number has more digits than the control takes. Leading zeros count, the decimal point does not.

Write fewer digits, or compute the value from two constants."

    "0116" NotInteger Error "number must be whole"
"This word takes a whole number only. A control stops with an alarm at a fraction that is written out, though it rounds the value of a variable or a bracket.

Write a whole number, or put the value in brackets if rounding is meant."

    "0117" VariableProgramNumber Error "program or sequence number from a variable"
"O and N take a written number only. Every other letter may have a variable or an expression.

Write the number."

    "0118" NullAssigned Error "#0 cannot be written"
"#0 is always vacant: it can be read, and assigning to it is an alarm.

Assign to another variable."

    "0119" LoopNumber Error "loop number is not 1, 2 or 3"
"DO and END take the numbers 1, 2 and 3. A number may be used again for loops that do not stand in one another.

Use a number that is free here, or jumps."

    "0120" AtanDivision Error "second argument of ATAN is not in brackets"
"A slash behind ATAN[..] makes it the function of two arguments, and the second must stand in brackets too; the control stops with an alarm.

Write `ATAN[a]/[b]` for the angle of a point, `[ATAN[a]]/b` for a quotient."

    "0121" RelationalSign Error "sign in place of a comparison word"
"These controls compare with EQ, NE, GT, GE, LT and LE. The signs = < > have no such meaning.

Write the word."

    "0122" DivisionByZero Error "division by zero"
"The divisor is the constant 0, at which the control stops with an alarm.

Correct the divisor."

    "0123" FunctionDomain Error "argument is outside the function's domain"
"The function has no value for this constant, and the control stops with an alarm.

Correct the argument."

    "0124" MacroCallNotAlone Error "other codes in the block of a macro call"
"A block that calls a macro with G65 or G66 takes nothing but the call and its arguments.

Put the other words into a block of their own."

    "0125" ArgumentBeforeCall Error "argument stands before the macro call"
"G65 and G66 must stand before their arguments. A word before them is not an argument.

Move the call to the head of the block."

    "0126" RoundBrackets Error "round brackets are comments"
"Parentheses hold comments here, also inside expressions. What stands in them is not computed.

Write `[` and `]`."

    "0128" BareIndirection Error "## needs brackets"
"The number of a variable that is itself a variable stands in brackets.

Write `#[#1]`."

    "0129" LoopWordSlip Error "D and a zero in place of DO"
"The word behind WHILE is DO, with the letter O. With a zero it is a D word, and the control stops with an alarm.

Write `DO`."

    "0130" NothingConditional Error "condition without a consequence"
"Nothing stands behind the condition, so nothing depends on it.

Add the statement, or remove the condition."

    "0131" OutputFormat Error "output format is wrong"
"A value that is put out needs two digits in brackets: places before the point and behind it, one at least and eight at most together.

Correct the format."

    "0132" LoopsCross Error "loops cross"
"An END closes a loop that is not the innermost one that is open. Loops may stand in one another; they may not overlap.

Put the ENDs in the opposite order of their DOs."

    "0133" LoopNotPaired Error "DO without END, or END without DO"
"Each DO needs an END with its number behind it in the same program.

Add the missing one."

    "0134" JumpIntoLoop Error "jump into a loop"
"The target stands between a DO and its END, and the jump does not. A loop may be left by a jump, not entered.

Jump to the block of the DO, or build the loop from jumps."

    "0135" ModalCallNotOpen Review "G67 without G66"
"There is no modal call to cancel. A parameter of the control decides whether that is an alarm or does nothing.

Remove the G67 if no modal call of a calling program is meant."

    "0136" AlarmIfRun Review "an alarm if this statement runs"
"The statement divides by the constant 0, or gives a function a constant that it has no value for. The control stops with
an alarm where it runs; a condition before it decides whether it does.

Make sure that the condition never holds, or that the alarm is meant."

    "0150" TooComplex Error "block is too long or nests too deeply to be read"
"Brackets nest deeper, or the statement or the line is longer, than any control takes. A line is read up to 262144 characters. The block is kept as it stands and not read further.

Divide the statement into steps with variables between them; give each block a line of its own."

    "0151" MixedLine Error "NC words and a macro statement on one line"
"On this control a line holds either NC words or a macro statement behind its `#`, never both.

Put the macro statement on a line of its own."

    "0152" MacroLineTooLong Review "macro line is longer than the control takes"
"A macro line of this control holds 63 characters, the `#`, blanks and the comment counted. What it does with a longer one is not known.

Shorten the comment, or divide the statement."

    "0153" LabelNotAlone Error "a label does not stand alone"
"A label has its line to itself: no statement, no word, and on some controls not even a comment may stand beside it.

Move what stands beside the label to the next line."

    "0154" ExponentForm Error "number in exponent form"
"This control has no exponent form of numbers.

Write the number out: 123000 for 1.23 times ten to the fifth."

    "0155" MacroComment Error "comment sign that is an operator here"
"On a macro line `(` and `*` belong to expressions; a comment begins with an apostrophe.

Write `'` in front of the comment."

    "0156" SemicolonInMacro Error "semicolon on a macro line"
"A macro line knows no semicolon. The parts of a PRINT list are divided by commas.

Write a comma, or take the semicolon away."

    "0157" UnterminatedText Error "text without its closing quotation mark"
"Text stands between two quotation marks on one line. Without the second one it is not known where it ends.

Add the quotation mark."

    "0158" ConditionExpected Error "a comparison is expected"
"IF, AND, OR and NOT want a comparison. What a number means there is not stated by any source; most often an operator was lost on the way, as in `IF V19 THEN` for `IF V1<=9 THEN`.

Write the comparison out, such as `V1<>0`."

    "0159" ComparisonAsValue Error "a comparison stands where a value is expected"
"A comparison has no value on this control that could be computed with, assigned or printed.

Use IF to choose between two assignments."

    "0160" VariableOnNcLine Error "variable may not stand among NC words"
"NC words of this control can take R variables only. A V variable has to be handed over on a macro line first.

Write `#R9=V1` on the line before, and `X+R9` here."

    "0161" EqualsOnNcLine Error "`=` among NC words"
"Outside macro lines an R variable is set by its sign, without `=`.

Write `R9+1.` here, or `#R9=1.` on a macro line."

    "0162" SignMissing Error "sign is missing between letter and variable"
"A word takes its value from an R variable only with a sign between them, which multiplies: `X+R2`, `X-R2`.

Write the sign."

    "0163" TextBehindComment Review "text behind a comment's closing bracket"
"On this control a comment runs from its opening bracket to the end of the line. Words behind the closing bracket are comment, and the control does not carry them out, whatever the programmer had in mind.

Put the comment at the end of the line, or take the words away."

    "0164" MarkMissing Review "macro statement without its `#`"
"The statement is written as at the command prompt, without the `#` that a line of a program needs.

Write `#` in front of it."

    "0167" NumberTooLarge Error "number is too large"
"A block number, program number, subscript or label number has more digits than anything on the control.

Correct the number."

    "0168" UnclosedComment Error "comment is not closed"
"A comment of this control ends at its closing bracket. Without it there is no telling where the words begin again.

Add the bracket."

    "0169" WordWithoutValue Error "word without a value"
"An address letter needs a number or a variable behind it.

Add the value, or take the letter away."

    "0170" MixedBlock Error "plain words and parametric words in one block"
"A block of this control holds words with numbers (`X10`), or words, assignments and jumps with variables (`X=V1`), not both. Only G codes stand with either.

Put the number into a variable, or divide the block."

    "0171" OneOperation Error "more than one operation in a statement"
"This control computes one operation in each assignment: two operands and one operator, or one function of one operand.

Divide the statement into steps with variables between them."

    "0172" NoBrackets Error "brackets in an expression"
"This control has no brackets in expressions; round brackets hold comments.

Divide the statement into steps with variables between them."

    "0173" UnknownFunction Error "unknown function"
"The control has no function of this name. The page of the dialect (`macroglot dialects`) lists those that it has.

Compute it from the functions that are there: the tangent as sine divided by cosine."

    "0174" ConstantInWord Error "constant in a parametric word"
"Behind the `=` of a word stands a variable. A constant is written without `=`, and then the block may not hold parametric words.

Put the constant into a variable."

    "0175" UnshownOperand Review "form of an operand that no manual shows"
"The manual shows a variable as the first operand of an operation and as the argument of a function. Whether a constant is taken there is not known.

Put the constant into a variable first."

    "0176" ValueNotReadable Error "address cannot be read back"
"The active value of this address cannot be read into a variable.

Keep the value in a variable of its own where it is set."

    "0177" SignedVariable Error "sign in front of a variable"
"This control takes no sign in front of a variable.

Multiply by -1 in a step of its own: `V1=V2* -1`."

    // ---- 02: dialects and machine profiles ----
    "0201" UnconfirmedFact Review "rests on an unconfirmed fact"
"The conversion depends on how a control behaves in a place where no maker's text says so. The message names the fact and where it is recorded in `dialects/`.

Check it on the machine or in its manual. A machine profile states it for good: a fact by its name in `confirm`, and the answer to a question under `[behaviours]`, as `divide.by.zero = \"alarm\"`."

    "0202" DialectTable Error "a table of `dialects/` is wrong"
"A table of facts about a control contradicts itself, names something that does not exist, or has a key that nothing reads. Nothing is converted with a table that is wrong.

Correct the row shown. `dialects/README.md` says what the columns mean."

    "0203" MachineProfile Error "the machine profile is wrong"
"The profile of a machine has a key that nothing reads, a value that its control cannot have, or names a fact that its table does not hold. A setting that was not understood would make every conversion for that machine doubtful, so none is made.

Correct the line shown. The profiles in `machines/` are examples; `macroglot dialects` lists what a control can be set to."

    // ---- 03: lowering ----
    "0301" NotUnderstood Error "meaning is not known"
"The block can be read, but the table of its control in `dialects/` has no meaning for this word or statement. Nothing is guessed: the program is refused.

If a machine builder defined the word, give its meaning in the machine profile."

    "0310" TargetMissing Error "no block has this label"
"A jump goes to a sequence number or a label that no block of the program has. The control would stop there with an alarm, so there is nothing to convert it to.

Correct the jump or add the label."

    "0311" TargetTwice Review "several blocks have this sequence number"
"A jump goes to a sequence number that stands more than once in the program. The conversion takes the one that the control's table says it finds (the message names its line), and the first where no source says.

Make the numbers differ."

    "0312" ModalConflict Error "modal state differs from path to path"
"The meaning of the block depends on what was set before it: the motion mode, the angle unit, the places of rounding. The ways that lead here set different ones, or none is known, so the block has no one translation.

State it in the block or just before it."

    "0313" ModalAssumed Review "rests on modal state from outside the program"
"The block depends on a mode that the program did not set itself: its caller or a program that it called did. The conversion takes it that the called program leaves the mode as it was, and that the caller is not in an arc mode.

State the mode in the block, or check the programs that are named."

    "0314" EarlyRead Review "may be read before the moves ahead of it are done"
"The control reads ahead: a position, an input or a counter that a statement reads may be the one before the last moves. The conversion reads it when they are done. Where the program means that too, nothing changes.

Put a wait before the statement to say so."

    "0315" Indexer Error "sends code to the maker's indexer"
"The statement passes text to a device that only this maker's controls have. Its text is for the indexer and has no meaning elsewhere.

Program the axis directly."

    "0316" FixedSubroutine Review "calls a subroutine that the maker keeps in the control"
"The subroutine is not part of the library, and what it does is not in any program here. Controls of other makers do not have it.

Write the routine as a program of the library."

    "0317" SpeedRange Review "a fraction of the spindle speed picks a belt range"
"On this control the digit behind the point of a spindle speed is no part of the speed: it picks the belt range. The speed is converted without it, and the range is left to the other control.

Check that the other machine picks the same range."

    "0318" SubroutineArea Error "subroutines at the head of the program are not closed"
"The program defines subroutines at its head, but the code that ends their area is missing, so nobody can tell where its main part begins.

Add the code that closes the area."

    "0319" SubroutineLeft Review "control leaves a subroutine without its end"
"A jump goes out of a subroutine or into one, or a subroutine runs into the end of its area. What the control does with the return that is still open is in no source.

End the subroutine by its own code, and jump within it only."

    "0330" RegisterUnset Error "the condition register is not set here"
"The jump looks at the condition register, but on one of the ways that lead here nothing in the program has set it: neither arithmetic nor a test, or a cycle ran in between that may have changed it. No source says what it holds then.

Put a test of the variable that is meant before the jump."

    "0331" CodeByVariable Review "a code is given by a variable"
"The G or M code, or the label, stands in a variable. Every assignment to that variable in the program gives it the same number, so the conversion takes that number. It does not look whether another program or the operator changes the variable.

Write the code itself, or check that nobody else writes the variable."

    "0343" ArgumentsMixed Error "arguments of both kinds are mixed"
"The call has repeated or unordered I, J and K, which count by place, beside letters that have locals of their own. This control takes one kind in a call, and what it does with both is not known.

Use each letter once, in order, or only A, B, C and sets of I, J, K."

    "0344" RepeatKeepsLocals Review "repeats of a call do not set its arguments again"
"On this control the arguments are set before the first pass only; each later pass begins with what the pass before left in the locals. A macro that changes its arguments runs differently the second time.

Look whether the macro assigns to its arguments. If it does not, nothing changes."

    "0345" SkipUnclear Error "the block skip has no one meaning here"
"The block-skip sign stands with a loop's end or beginning, or twice in its block. What the control then leaves out cannot be said for sure.

Give the words that are skipped a block of their own."

    "0346" ThenMissing Review "THEN is missing"
"A statement follows the condition without THEN. Programs are seen that do so, and the conversion takes it that the statement is done when the condition holds; the maker's text has no such form.

Write THEN before the statement."

    "0347" OutputBlank Review "a blank in formatted output"
"The text that a program puts out has a blank in it. The sign that is sure to print a blank is '*'; some controls leave blanks out. The conversion prints it.

Write '*' for each blank that must be printed."

    "0348" NotWritable Error "cannot be assigned to"
"The variable can be read only. The control stops with an alarm at the assignment."

    "0349" LatheProgram Error "looks like a lathe program"
"The table for milling machines gives this word another meaning than a lathe does, or none, and the block looks like one for a lathe. Read as a milling program it would move otherwise than it was meant to.

Programs that such a program calls or that call it, those of its file, and in a library without mill programs all others, go with it, unless their own text is a mill's (Y, a length offset, M6). The message names the file and line where the sign was seen.

Name a machine profile with 'machine = \"lathe\"', or with 'machine = \"mill\"' if it is a mill's after all."

    "0350" ComputedCode Note "a code is known only at run time"
"The number of the G or M code is computed. What it does depends on the value when the program runs, so only a control with the same codes can do the same, and a code that ends or calls would not be followed.

Write the codes out, each behind its condition."

    "0351" GroupTwice Review "two codes of one group in a block"
"Codes of one group exclude one another. Most controls let the last one of a block count; both are converted in their order.

Leave one of them out."

    "0352" WordTwice Review "a word stands twice in its block"
"Two words of the block mean the same thing. Most controls let the last one count; both are converted in their order.

Leave one of them out."

    "0353" MCodes Review "more M codes than the control takes"
"The block has more M codes than its control accepts in one block. It may stop with an alarm there, or do only some of them.

Put each into a block of its own."

    "0354" WholeWithPoint Review "a decimal point in a whole-number word"
"The word takes a whole number, and some controls stop with an alarm at a decimal point in it. The number is converted without the point.

Leave the point out."

    "0355" WordsBesideCall Review "words stand beside the end of a modal call"
"No source says whether the words of that block act before the modal call ends or after it. They are taken to act after it.

Put them into a block of their own."

    // ---- 04: legalization ----
    "0401" NoEquivalent Error "the target control has no such function"
"The target control lacks the function, and none of the emulations gives it exactly. The message says which function and why."

    "0402" NearlyEqual Review "the same within a bound"
"The target lacks the function, or has it with another range, and an emulation stands in its place that agrees inside a stated domain or within a stated bound. The message says which.

Look whether the program can leave the domain, or is so fine that the bound matters."

    "0403" OutOfRegisters Error "no register left"
"Every variable of the library needs a register of its own on the target, and the target (as the machine profile describes it) has too few, or too few in a row where variables are reached by computed numbers.

Free registers by the profile's `reserved` list, buy the option for more variables, or convert a smaller library."

    "0404" OtherRetention Review "a variable lives longer or shorter"
"A variable keeps its value over power-off on one of the controls and loses it on the other, and the program reads it before it writes it.

If nobody relies on the value from before power-off, nothing needs doing. Else move it by hand to a register that lives as long as it did."

    "0405" Conditional Review "the same under a condition"
"The target does the same only if something holds that the text of the programs does not say: what the operator does at a stop, how inputs are wired, which unit the control is set to. The message names the condition.

See that it holds on the machine; where a machine profile can state it, state it there."

    "0406" MessageCut Note "message is shown in part"
"The target shows fewer characters of a message than the source. The message is cut, and the whole of it stands in a comment beside it."

    "0407" LettersReplaced Note "letters that the target lacks are replaced"
"A message, a line of output or a comment has letters or signs that the target control is not known to show, as those with accents. What looks like them stands in their place: UE for Ü, C for Ç, EUR for €. Round brackets inside a message become square ones, and a per cent sign becomes PCT. It is said once a program, at the first of them.

Nothing needs doing. A letter in a message for which nothing stands is told by MG0507."

    // ---- 05: emission ----
    "0501" Unmapped Error "the target has no spelling for this"
"The table of the target control in `dialects/` has no row for something that the program needs: a code, a letter, a function, a register. Nothing is written in its place, so the program is refused.

The message names what is missing. Where the machine has it, say so in its profile or in the table; where it has not, the conversion should have replaced it earlier, which is a fault of this program worth reporting."

    "0502" NestsTooDeep Error "brackets nest too deep"
"The expression needs more brackets inside one another than the target control takes, those of functions and of conditions counted.

Split the expression over two assignments in the source."

    "0503" NumberTooLong Error "the number has too many digits"
"The number cannot be written with the digits that the target control takes without changing its value.

Round it in the source to what the machine needs."

    "0504" LineTooLong Error "the block is too long"
"The block has more characters than a line of the target control may have, its comments aside, which are put on lines of their own.

Split the block in the source."

    "0505" NoSequenceNumber Error "a sequence number cannot be given"
"A block that is jumped to needs a sequence number that only it has. Either all numbers that the control takes are used, or the number is fixed, by a computed jump or by a return to it, and two blocks would need it.

Renumber the blocks of the source."

    "0506" TextUnwritable Error "the text cannot be written on the target"
"A line of output or a name holds characters that the target control cannot write. What the receiver reads would change.

Write it without these characters."

    "0507" MessageAltered Review "the message looks different on the target"
"A message to the operator holds characters that the target control cannot write, for which others stand, or it has more characters than the control shows, and its end may be missing on the screen.

Check that the operator still understands it, or shorten it in the source."

    "0599" Internal Error "fault of macroglot itself"
"A check that macroglot makes of its own work failed: the program it was about to write breaks a rule of its intermediate form or of the target's grammar. Nothing of it was written.

Please report the program with this message."

    // ---- 06: libraries and projects ----
    "0601" OutsideLibrary Review "calls a program outside the library"
"The program calls one that was not among the files converted, or one that is refused, for which nothing is written. The call keeps its number, but nothing is known of what it does: which variables it changes, which modes it leaves in force, whether it exists on the target.

Convert the whole library in one run, mend what is refused, or check the program on the target by hand."

    "0602" TwinProgram Review "a program number stands twice"
"Two programs of the library have one number. A control holds one program of a number, so the shop loads one of them or the other; the conversion cannot tell which.

Convert them apart, or give one another number."

    "0603" AmbiguousCall Error "calls a program that stands twice"
"The program calls a number that two programs of the library have. Which one runs decides what the machine does, so nothing is guessed.

Convert the two in separate runs, each with its own callers."

    "0604" OutOfNumbers Error "no program number is free"
"A program that has no number on the source, or a subroutine that becomes a program of its own, needs a number on the target, and none is free."

    "0605" Renumbered Note "a program gets another number"
"The number of the program is larger than the target control takes, so the program gets one that is free there. Calls in the library that name it get the new number too; `macroglot.lock` keeps it for later runs.

Whoever selects the program at the machine, or calls it from outside the library, must use the new number."

    "0606" CalleeWithdrawn Error "calls a program that is withdrawn"
"The program calls one whose conversion does something else than its source, by what their runs on the emulated controls show (MG0801). That one is not written, so what calls it is not written either: it would run something else, or stop with an alarm. Other programs of the file and of the library are written.

Look at the program that is named first; what calls it comes back with it."

    "0610" LockConflict Error "an earlier conversion has this register"
"`macroglot.lock` in the output folder keeps registers for programs that were converted before and are not part of this run. A program of this run needs one of them for itself: its variable has that number on both controls, or variables whose numbers are computed need a row of registers.

Delete `macroglot.lock`, and convert the files that the message names and these in one run."

    "0611" LockChanged Note "a variable gets another register than before"
"An earlier run chose a register that a program of the library now needs for itself. All programs that rely on the choice are part of this run, so the variable gets another one, and all of them are written anew.

Load all of the programs into the machine. If a value in the old register matters, move it by hand."

    // ---- 07: the command line ----

    // ---- 08: emulated controls and verification ----
    "0801" VerifiedDifferent Error "the conversion does something else"
"Source and conversion were run on their emulated controls, and the machine would not do the same. The message names the first difference; the certificate has the circumstances, both blocks and both events. Nothing of the program is written, and nothing of what calls it (MG0606); other programs of its file are. The certificate stands in the output folder as `NAME.not-written.json`, never beside a text under the name of one that is.

One of three is at fault: the conversion, one of the emulated controls, or a table in `dialects/`. Please report the program with its certificate."

    "0802" NotDecided Review "verification did not decide"
"Source and conversion were run on their emulated controls and no difference was found, but not everything was seen: a branch that no scenario reached, a run that came to no end, a called program that is not in the library, an unconfirmed fact that mattered. The message says which.

Look at the places named, or give the machine profile what it lacks, and verify again with `macroglot verify`."

    "0803" RoundingSensitive Review "rounding decides what the machine does"
"When the target's arithmetic keeps a few digits less, or errs in the last of them, the machine does something else: a comparison of computed values is so close that the last digit decides it. Two controls of one make can differ there.

Compare with a small margin, or round before comparing, in the source."

    "0804" AlarmRaised Error "the program ends in an alarm"
"The program was run on its emulated control, which stopped with an alarm here. The message has the alarm's number on the control, where a source names it, and its text; a number that the program gave itself stands with what the control adds to it.

Where the alarm is the program's own check, run it with the values that it wants: `--set '#1=2.5'`."

    "0805" NoEnd Error "the program does not come to its end"
"The program was run on its emulated control and used up the blocks, events or time that it was given; the place is where it was then. A loop that waits for an input, or a main program that begins again, runs for ever without a person at the machine.

Look for the loop at this place; a scenario file can set inputs. A program that is only long is run to its end with `--steps`."

    "0806" CannotRun Error "the program cannot be run"
"The emulated control came to a block that it cannot read or does not know how to run, or to a call of a program that it does not have.

Give the files of called programs with `--library`."
}
