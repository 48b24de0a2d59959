//! Groups of tokens: operators with operands, brackets, blocks, statements.

use crate::token::{Kind, Token};
use crate::word::Word;
use crate::words::reserved;

/// The role of a token among its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// An opening parenthesis or bar.
    Opens,
    /// A closing parenthesis or bar.
    Closes,
    /// A minus without a left operand.
    Prefix,
    /// A value, or a part of one that another part may follow without a blank.
    Operand,
    Other,
}

/// A token with its role.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element<'t> {
    pub(super) token: Token<'t>,
    pub(super) role: Role,
    /// True if a statement or an item begins here.
    pub(super) begins: bool,
    /// The block that a brace opens or closes.
    pub(super) block: Option<usize>,
}

/// The content of a pair of braces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    /// Index of the opening brace.
    pub(super) open: usize,
    /// Index of the closing brace.
    pub(super) close: usize,
    /// The first block of the same statement: for `else`, the block of `if`. Otherwise the block itself.
    pub(super) first: usize,
}

impl Block {
    pub(super) fn is_empty(&self) -> bool {
        self.close == self.open + 1
    }
}

/// The tokens of a text with their roles, and its blocks.
#[derive(Debug)]
pub(super) struct Structure<'t> {
    pub(super) elements: Vec<Element<'t>>,
    /// In the order of their opening braces.
    pub(super) blocks: Vec<Block>,
}

/// The structure of a text whose statements and items begin at the bytes `starts`, in ascending order.
pub(super) fn structure<'t>(tokens: Vec<Token<'t>>, starts: &[usize]) -> Structure<'t> {
    let mut starts = starts.iter().copied().peekable();
    let mut before: Option<Element<'t>> = None;
    let (mut elements, mut blocks) = (Vec::with_capacity(tokens.len()), Vec::<Block>::new());
    // For every open block, its index and the first block of its current statement.
    let mut open: Vec<(usize, Option<usize>)> = vec![];
    let mut first = None;
    // The names after `use` are not values, and its list is not a list of arguments.
    let mut is_use = false;
    for token in tokens {
        let index = elements.len();
        if token.kind == Kind::Comment {
            elements.push(Element { token, role: Role::Other, begins: false, block: None });
            continue;
        }
        let mut begins = before.is_none_or(|before| before.token.is("{"));
        while starts.next_if(|&start| start <= token.start).is_some() {
            begins = true;
        }
        if begins {
            first = None;
            is_use = token.kind == Kind::Keyword && token.text == "use";
        }
        let mut block = None;
        if token.is("{") {
            let number = blocks.len();
            let first_of_statement = *first.get_or_insert(number);
            blocks.push(Block { open: index, close: index, first: first_of_statement });
            block = Some(number);
            open.push((number, first.take()));
        } else if token.is("}")
            && let Some((number, first_of_statement)) = open.pop()
        {
            blocks[number].close = index;
            (block, first, begins) = (Some(number), first_of_statement, false);
        }
        let after_operand = !begins && before.is_some_and(|before| matches!(before.role, Role::Operand | Role::Closes));
        let role = if is_use && !token.is("(") && !token.is(")") { Role::Other } else { role(&token, after_operand) };
        let element = Element { token, role, begins, block };
        before = Some(element);
        elements.push(element);
    }
    Structure { elements, blocks }
}

fn role(token: &Token<'_>, after_operand: bool) -> Role {
    match token.kind {
        Kind::Name | Kind::Number | Kind::Unit | Kind::Text => Role::Operand,
        Kind::Keyword if reserved(token.text).is_some_and(Word::is_value) => Role::Operand,
        Kind::Keyword | Kind::Comment => Role::Other,
        Kind::Mark => match token.text {
            ")" | "]" => Role::Closes,
            "|" if after_operand => Role::Closes,
            "(" | "[" | "|" => Role::Opens,
            "-" if !after_operand => Role::Prefix,
            _ => Role::Other,
        },
    }
}
