"""The commands of the vehicle on show, what became of the last one, and how far its job is."""

from services.gcs.orders.offers import Offer, offers
from services.gcs.state.control import called
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.vehicle.progress import order_line, progress_line


def command_panel(model: Model, v: VehicleModel, session: BrowserSession, t: float) -> Html:
    """The panel at ``t`` [s, wall] as one page sees it."""
    shown = offers(model, v)
    buttons = joined(_button(offer, v, session, t) for offer in shown)
    return html(
        "<h2 class='g-h'>{}</h2>{}<div class='g-two'>{}</div>{}{}{}",
        v.name,
        _control(model, v, session, t),
        buttons,
        _reason(shown),
        order_line(v.order),
        progress_line(v),
    )


def _button(offer: Offer, v: VehicleModel, session: BrowserSession, t: float) -> Html:
    sure = offer.risky and not offer.why_not and session.confirms(v.name, offer.key, t)
    label = f"Confirm: {offer.label[0].lower()}{offer.label[1:]}" if sure else offer.label
    style = "g-btn g-sure" if sure else "g-btn g-main" if offer.main and not offer.why_not else "g-btn"
    more = html("aria-disabled='true' data-key='{}'", offer.key) if offer.why_not else html("data-key='{}'", offer.key)
    hint = offer.why_not or (f"{offer.hint}; asks for a second click" if offer.risky else offer.hint)
    pressed = offer.lit if offer.name == "mode" and not offer.risky else None
    return button(label, "command", v.name, offer.key, style=style, more=more, hint=hint, pressed=pressed)


def _reason(shown: list[Offer]) -> Html:
    """Why some of them cannot be given, each reason once."""
    reasons = list(dict.fromkeys(offer.why_not for offer in shown if offer.why_not))
    return joined(html("<p class='g-why'>{}</p>", reason) for reason in reasons)


def _control(model: Model, v: VehicleModel, session: BrowserSession, t: float) -> Html:
    """Who controls it, when that is somebody else; and who asks for it, when it is this page's."""
    control = model.control
    asked = control.asking.get(v.name)
    if control.reason_against(v.name, session.operator, model.present):
        holder = called(control.holders[v.name])
        mine = asked is not None and asked[0] == session.operator
        ask = html("<span class='g-idle'>asked for, {:.0f} s</span>", t - asked[1]) if mine and asked is not None else html("")
        take = html("") if mine else button("Ask for control", "request-control", v.name, style="g-btn g-wide")
        return html("<div class='g-order g-warn'>{} controls {} {}{}</div>", holder, v.name, ask, take)
    if asked is not None and control.holders.get(v.name) == session.operator:
        give = button("Hand over", "answer-control", v.name, True)
        keep = button("Keep", "answer-control", v.name, False)
        return html(
            "<div class='g-order g-warn' role='alert'>{} asks for control<div class='g-row'>{}{}</div></div>", called(asked[0]), give, keep
        )
    return html("")
