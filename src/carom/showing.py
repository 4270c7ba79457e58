"""Pictures of a simulation as it is now."""

from carom.keeping import Keeping
from carom.pictures.look import Color, Theme
from carom.pictures.painter import Style
from carom.pictures.picture import Picture, paint, small_png
from carom.scene import Camera


class Showing(Keeping):
    """The part of `carom.Simulation` that draws itself."""

    def picture(
        self,
        *,
        size: tuple[int, int] = (1280, 720),
        camera: Camera | None = None,
        color: Color | None = None,
        theme: Theme = "dark",
        shadows: bool = True,
        quality: str = "good",
        caption: bool = True,
    ) -> Picture:
        """Draw it as it is now; `carom.render` explains the options, and makes films.

        Returns
        -------
        Picture
            Notebooks show it; `save` writes it into a file.

        Raises
        ------
        InputError
            If a value cannot be used, Pillow is missing for the words, or there are no spheres.

        Examples
        --------
        >>> import carom
        >>> sim = carom.Simulation(carom.scenes.gas(n=50))
        >>> sim.picture(size=(640, 360))
        <Picture: 640 x 360 pixels>
        """
        style = Style.of(
            self._scene,
            size=size,
            camera=camera,
            color=color,
            theme=theme,
            shadows=shadows,
            quality=quality,
        )
        title = "" if self._scene is None else self._scene.title
        return paint(self.state, self.world, style, title, caption)

    def _repr_png_(self) -> bytes | None:
        return None if len(self) == 0 else small_png(self.state, self.world, self._scene)
