//! Edits of lists: elements added, taken away, moved, switched off and on.

use shadewright_compiler::Report;

use super::{Ancestor, Draft, Parked};

impl Draft {
    /// RON of a list's elements; none where there is no list.
    pub fn elements(&self, list: &str) -> Vec<String> {
        let element = |index| self.scene.get(&format!("{list}[{index}]")).map(str::to_owned);
        (0..).map_while(element).collect()
    }

    fn set_elements(&mut self, above: &[Ancestor], list: &str, elements: &[String]) -> Result<(), Report> {
        let text = elements.join(", ");
        self.set(above, list, &format!("[{text}]"))
    }

    /// Adds an element at the end.
    ///
    /// # Errors
    /// What comes out is no scene.
    pub fn add(&mut self, above: &[Ancestor], list: &str, element: &str) -> Result<(), Report> {
        let mut elements = self.elements(list);
        elements.push(element.to_owned());
        self.set_elements(above, list, &elements)
    }

    /// Takes an element away, for good or until it is switched on again.
    ///
    /// # Errors
    /// There is no such element, or what is left is no scene.
    pub fn remove(&mut self, above: &[Ancestor], list: &str, index: usize, park: bool) -> Result<(), Report> {
        self.write_out(above)?;
        let path = format!("{list}[{index}]");
        let text = self.scene.get(&path).unwrap_or_default().to_owned();
        self.scene = self.scene.unset(&path)?;
        if park {
            let list = list.to_owned();
            self.parked.push(Parked { list, index, text });
        }
        Ok(())
    }

    /// Moves an element by one place.
    ///
    /// # Errors
    /// What comes out is no scene.
    pub fn shift(&mut self, above: &[Ancestor], list: &str, index: usize, up: bool) -> Result<(), Report> {
        self.write_out(above)?;
        let mut elements = self.elements(list);
        let other = if up { index.checked_sub(1) } else { Some(index + 1) };
        if let Some(other) = other.filter(|&other| other < elements.len() && index < elements.len()) {
            elements.swap(index, other);
            self.set_elements(above, list, &elements)?;
        }
        Ok(())
    }

    /// Switches an element on again that was switched off.
    ///
    /// # Errors
    /// What comes out is no scene.
    pub fn unpark(&mut self, above: &[Ancestor], which: usize) -> Result<(), Report> {
        if which >= self.parked.len() {
            return Ok(());
        }
        let Parked { list, index, text } = self.parked.remove(which);
        let mut elements = self.elements(&list);
        elements.insert(index.min(elements.len()), text);
        self.set_elements(above, &list, &elements)
    }
}
