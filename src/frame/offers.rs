//! What methods of a frame offer to each other while they declare their passes: values found by their type.

use std::any::Any;
use std::cell::RefCell;
use std::rc::Rc;

/// Values of different types.
#[derive(Default)]
pub(crate) struct Offers {
    values: RefCell<Vec<Rc<dyn Any>>>,
}

impl Offers {
    /// Offers a value to the methods that declare later.
    pub(crate) fn put<T: 'static>(&self, value: T) {
        self.values.borrow_mut().push(Rc::new(value));
    }

    /// What was offered, if it was.
    pub(crate) fn get<T: 'static>(&self) -> Option<Rc<T>> {
        self.values.borrow().iter().find_map(|value| value.clone().downcast::<T>().ok())
    }

    /// The first of those of this type that `wanted` is true of.
    pub(crate) fn find<T: 'static>(&self, wanted: impl Fn(&T) -> bool) -> Option<Rc<T>> {
        let values = self.values.borrow();
        values.iter().filter_map(|value| value.clone().downcast::<T>().ok()).find(|value| wanted(value))
    }
}
